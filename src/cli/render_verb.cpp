#include "base/error.h"
#include "base/image.h"
#include "cli/method_flags.h"
#include "cli/scene_flags.h"
#include "cli/verbs.h"
#include "judge/filtered_truth.h"
#include "judge/texel_density.h"
#include "lab/core/depth_images.h"
#include "lab/picture/pictures.h"
#include "planar/planar_map.h"

#include <array>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct RenderFlags {
  SceneFlags scene;
  MethodFlags method;
  std::string out;
  std::string show = "beauty";
};

constexpr std::array kShows = {"beauty", "visibility",   "truth",     "difference",   "labels",
                               "depth",  "second-depth", "layer-gap", "texel-density"};

struct Picture {
  Image8 png;
  ImageF exr;
  std::vector<std::string> channels;
};

ImageF oneChannel(const Session& session, const std::vector<float>& values) {
  ImageF image(session.view().width, session.view().height, 1);
  image.values = values;
  return image;
}

Picture depthImage(const Session& session, const DrawnMap& map, const std::string& show) {
  const DepthImages depth = depthInMetres(session, map);
  const ImageF& metres = show == "depth" ? depth.first : show == "second-depth" ? *depth.second : *depth.gap;
  return {depthPicture(metres), metres, {"metres"}};
}

Picture renderPicture(const Session& session, const CompareOptions& options, const std::string& show) {
  Passes passes(session.device(), session.view());
  const Parameterization& parameterization = *options.maps.front();
  const Method method = methodFor(session, options, *options.biases.front());
  const Filter& filter = *options.filters.front();
  const Exact exact = computeExact(session, parameterization);
  const int side = mapSideOf(options, parameterization);
  const FittedMap fitted = fitMap(session, parameterization, exact, side, options.mapOptions).fitted;
  if (!fitted.note.empty()) std::fprintf(stderr, "gnomon: %s\n", fitted.note.c_str());
  if (show == "texel-density") {
    const std::vector<float> densities = texelDensities(fitted, exact.receivers);
    const std::string title =
        fmt::format("{}, {} x {} x {} texels, fit {}, warp {}", parameterization.name(), fitted.map.layerCount, side,
                    side, options.mapOptions.text(kWindowFit), options.mapOptions.text(kWarp));
    return {densityPicture(exact.receivers, densities, title), oneChannel(session, densities), {"texels_per_m2"}};
  }
  const bool layers = show == "second-depth" || show == "layer-gap";
  const DrawnMap map = drawMap(session, passes.renderers, fitted, exact,
                               layers ? MapContent::TwoLayers : method.bias->content, options.cull);
  if (layers || show == "depth") return depthImage(session, map, show);
  if (show == "labels") {
    const Judged judged = judge(session, passes, map, exact, method);
    const std::string title = fmt::format("{} {}, {} x {} texels", parameterization.name(), method.bias->name,
                                          fitted.map.side, fitted.map.rows);
    std::vector<float> numbers;
    for (const Label label : judged.labels.labels) numbers.push_back(static_cast<float>(label));
    return {labelPicture(exact.receivers, exact.truth, judged.labels, title), oneChannel(session, numbers), {"label"}};
  }
  std::vector<float> truth;
  if (show == "truth" || show == "difference")
    truth = computeFilteredTruth(session.tracer(), exact.light, exact.receivers, exact.truth, fitted, filter.id);
  if (show == "truth") return {visibilityPicture(exact.receivers, truth), oneChannel(session, truth), {"Y"}};
  const std::vector<float> visibility = filteredVisibility(session, passes, map, exact, method, filter.id);
  if (show == "difference") {
    ImageF difference = oneChannel(session, visibility);
    for (size_t i = 0; i < truth.size(); ++i) difference.values[i] -= truth[i];
    return {differencePicture(exact.receivers, visibility, truth), difference, {"Y"}};
  }
  if (show == "visibility")
    return {visibilityPicture(exact.receivers, visibility), oneChannel(session, visibility), {"Y"}};
  const ImageF radiance = renderRadiance(session, passes, exact, visibility);
  return {toSrgb8(radiance), radiance, {"R", "G", "B"}};
}

int runRender(const RenderFlags& flags) {
  const std::string extension = std::filesystem::path(flags.out).extension().string();
  if (extension != ".png" && extension != ".exr")
    throw UsageError(fmt::format("-o {}: write a .png or an .exr", flags.out));
  CompareOptions options = compareOptions(flags.method);
  if (options.biases.size() > 1 && !options.userBiases.empty())
    options.biases.erase(options.biases.begin(), options.biases.end() - 1);  // a file given is the bias meant
  if (options.maps.size() != 1 || options.biases.size() != 1 || options.filters.size() != 1)
    throw UsageError("render draws one configuration: give one --maps, one --biases and one --filters");
  preloadImages();
  const Session session = openSession(flags.scene);
  const Picture picture = renderPicture(session, options, flags.show);
  if (extension == ".exr")
    writeExr(flags.out, picture.exr, picture.channels);
  else
    writePng(flags.out, picture.png);
  std::printf("wrote %s\n", flags.out.c_str());
  return 0;
}

Run add(CLI::App* verb) {
  auto flags = std::make_shared<RenderFlags>();
  addSceneFlags(*verb, flags->scene);
  addMethodFlags(*verb, flags->method, "spot", "adaptive");
  verb->add_option("-o,--out", flags->out, "the picture: .png (for people) or .exr (linear data)")->required();
  verb->add_option("--show", flags->show,
                   "beauty, visibility, truth, difference (visibility - truth), labels, depth, second-depth, "
                   "layer-gap or texel-density (texels per square metre)")
      ->check(CLI::IsMember(std::vector<std::string>(kShows.begin(), kShows.end())))
      ->capture_default_str();
  return [flags] { return runRender(*flags); };
}

}  // namespace

Verb renderVerb() {
  return {.name = "render", .sentence = "one picture of one configuration, PNG or EXR", .add = add};
}

}  // namespace gnomon
