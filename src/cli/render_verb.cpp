#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/terminal.h"
#include "cli/choice.h"
#include "cli/method_flags.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/scene_flags.h"
#include "cli/verbs.h"
#include "lab/compare/render_picture.h"
#include "lab/core/maps.h"

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
  std::string prediction;
  const CLI::Option* biases = nullptr;
};

// A volume stores no triangles: there the default is the best that depth alone allows.
MethodFlags methodOf(const RenderFlags& flags) {
  MethodFlags method = flags.method;
  if (method.map.maps.empty()) return method;
  const auto maps = parseMaps(method.map.maps);
  if (flags.biases->count() == 0 && !maps.front()->supportsBias(findBias(kDefaultBias)))
    method.bias.biases = "adaptive";
  return method;
}

int runRender(const RenderFlags& flags) {
  const std::string extension = std::filesystem::path(flags.out).extension().string();
  if (extension != ".png" && extension != ".exr" && !isStream(flags.out))
    throw UsageError(fmt::format("-o {}: the name must end in .png or .exr", flags.out));
  refuseAllLights(flags.scene, "render");
  CompareOptions options = compareOptions(methodOf(flags));
  if (flags.biases->count() == 0 && !options.userBiases.empty())
    options.biases.erase(options.biases.begin());  // a file given is the bias meant, not the default
  if (options.maps.size() != 1 || options.biases.size() != 1 || options.filters.size() != 1)
    throw UsageError(
        "render draws one configuration: give one --maps, one bias (--biases or --bias-file) and one --filters");
  checkOutput(flags.out);
  if (extension == ".exr") preloadImages();
  const Session session = openSession(flags.scene);
  chooseUsualMap(flags.method, session, options);
  if (!flags.prediction.empty() && flags.show != "labels")
    throw UsageError("--prediction is another renderer's visibility, which is labelled: give --show labels");
  const RenderedPicture picture = flags.prediction.empty() ? renderPicture(session, options, flags.show)
                                                           : renderLabelsOf(session, options, flags.prediction);
  if (!picture.note.empty()) std::fprintf(stderr, "gnomon: %s\n", picture.note.c_str());
  if (extension == ".exr")
    writeExr(flags.out, picture.exr, picture.channels);
  else
    writePng(flags.out, picture.png);
  const std::string exposed =
      picture.exposure > 0.0 ? fmt::format(", exposed by {:.6g} per cd/m^2", picture.exposure) : "";
  say(fmt::format("wrote {}{}\n", flags.out, exposed));
  return 0;
}

Run addRender(CLI::App* verb) {
  auto flags = std::make_shared<RenderFlags>();
  addSceneFlags(*verb, flags->scene);
  addMethodFlags(*verb, flags->method, kDefaultBias, "one of", "one of");
  addExposureFlag(*verb, flags->method.map.exposure);
  flags->biases = verb->get_option("--biases");
  verb->get_option("--exposure")->group("View and device");
  const OptionGroup group(*verb, "Picture");
  offersFiles(verb->add_option("-o,--out", flags->out, "the picture: .png (8 bits, for viewing) or .exr (linear data)")
                  ->required());
  offersOneOf(
      verb->add_option("--show", flags->show,
                       "beauty, visibility, truth, difference (visibility - truth), labels, depth, second-depth, "
                       "layer-gap (second depth - first), ids (the triangle each texel of the map sees) or "
                       "texel-density (texels per square metre)")
          ->check(oneOf(picturesToShow()))
          ->capture_default_str(),
      picturesToShow());
  offersFiles(verb->add_option("--prediction", flags->prediction,
                               "with --show labels: another renderer's picture of the same scene, light and camera, "
                               "white where lit, black in shadow, grey where it drew nothing; its labels' counts are "
                               "told"));
  return [flags] { return runRender(*flags); };
}

}  // namespace

Verb renderVerb() {
  return {.name = "render", .sentence = "renders one picture of one configuration, PNG or EXR", .add = addRender};
}

}  // namespace gnomon
