#include "lab/compare/render_picture.h"

#include "base/error.h"
#include "lab/core/depth_images.h"
#include "lab/picture/pictures.h"
#include "planar/planar_map.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace gnomon {

namespace {

// What a picture is made of.
struct Subject {
  LightOnMap& lit;
  const Method& method;
  ChosenFilter filter;

  const Receivers& receivers() const { return lit.receivers(); }
  std::vector<float> visibility() const { return lit.visibility(method, filter); }
  std::vector<float> truth() const { return lit.filteredTruth(filter); }
};

ImageF oneChannel(const Subject& subject, const std::vector<float>& values) {
  ImageF image(subject.receivers().width, subject.receivers().height, 1);
  image.values = values;
  return image;
}

RenderedPicture beauty(const Subject& subject) {
  const ImageF radiance = subject.lit.picture(subject.method, subject.filter);
  return {toSrgb8(radiance), radiance, {"R", "G", "B"}, {}};
}

RenderedPicture grey(const Subject& subject, const std::vector<float>& values) {
  return {visibilityPicture(subject.receivers(), values), oneChannel(subject, values), {"Y"}, {}};
}

RenderedPicture visibility(const Subject& subject) {
  return grey(subject, subject.visibility());
}

RenderedPicture truth(const Subject& subject) {
  return grey(subject, subject.truth());
}

RenderedPicture difference(const Subject& subject) {
  const std::vector<float> exact = subject.truth(), predicted = subject.visibility();
  ImageF values = oneChannel(subject, predicted);
  for (size_t i = 0; i < exact.size(); ++i) values.values[i] -= exact[i];
  return {differencePicture(subject.receivers(), predicted, exact), values, {"Y"}, {}};
}

RenderedPicture labels(const Subject& subject) {
  LightOnMap& lit = subject.lit;
  const LabelledResult judged = lit.judge(subject.method);
  const std::string title = fmt::format("{} {}, {} x {} texels", lit.parameterization().name(),
                                        subject.method.bias->name, lit.fitted().map.width, lit.fitted().map.height);
  std::vector<float> numbers;
  for (const Label label : judged.labels.labels) numbers.push_back(static_cast<float>(label));
  return {
      labelPicture(lit.receivers(), lit.truth(), judged.labels, title), oneChannel(subject, numbers), {"label"}, {}};
}

RenderedPicture metres(const ImageF& depth) {
  return {depthPicture(depth), depth, {"metres"}, {}};
}

DepthImages depthsOf(LightOnMap& lit, ChannelSet channels) {
  return depthInMetres(lit.view().device(), lit.occluders(channels));
}

RenderedPicture depth(const Subject& subject) {
  return metres(depthsOf(subject.lit, glsl::kChannelDepth).first);
}

DepthImages twoDepthsOf(LightOnMap& lit) {
  if (!lit.parameterization().supportsBias(findBias("dual")))
    throw UsageError(fmt::format("--show: a {} map stores one depth; choose depth", lit.parameterization().name()));
  return depthsOf(lit, glsl::kChannelDepth | glsl::kChannelSecondDepth);
}

RenderedPicture secondDepth(const Subject& subject) {
  return metres(*twoDepthsOf(subject.lit).second);
}

RenderedPicture layerGap(const Subject& subject) {
  return metres(*twoDepthsOf(subject.lit).gap);
}

RenderedPicture texelDensity(const Subject& subject) {
  const LightOnMap& lit = subject.lit;
  const std::vector<float> densities = lit.texelDensities();
  const MapSetup& setup = lit.setup();
  const std::string title = fmt::format("{}, {} x {} x {} texels, fit {}, warp {}", lit.parameterization().name(),
                                        lit.fitted().map.sliceCount, setup.side, setup.side,
                                        setup.options.text(kWindowFit), setup.options.text(kWarp));
  return {densityPicture(lit.receivers(), densities, title), oneChannel(subject, densities), {"texels_per_m2"}, {}};
}

struct ShowChoice {
  const char* name;
  RenderedPicture (*draw)(const Subject& subject);
};
constexpr std::array kShown = {ShowChoice{"beauty", beauty},
                               ShowChoice{"visibility", visibility},
                               ShowChoice{"truth", truth},
                               ShowChoice{"difference", difference},
                               ShowChoice{"labels", labels},
                               ShowChoice{"depth", depth},
                               ShowChoice{"second-depth", secondDepth},
                               ShowChoice{"layer-gap", layerGap},
                               ShowChoice{"texel-density", texelDensity}};

}  // namespace

std::vector<std::string> picturesToShow() {
  std::vector<std::string> names;
  for (const ShowChoice& shown : kShown) names.emplace_back(shown.name);
  return names;
}

RenderedPicture renderPicture(const Session& session, const CompareOptions& options, const std::string& show) {
  const auto* const shown = std::ranges::find_if(kShown, [&](const ShowChoice& s) { return s.name == show; });
  if (shown == kShown.end()) throw UsageError(fmt::format("--show {}: no such picture", show));
  const Parameterization& map = *options.maps.front();
  ShadowPasses passes(session);
  LightOnMap lit = openLight(session, passes, map, mapSetupOf(options, map));
  const Method method = methodFor(session, options, *options.biases.front());
  RenderedPicture picture = shown->draw({lit, method, filterFor(options, *options.filters.front())});
  picture.note = lit.fitted().note;
  return picture;
}

}  // namespace gnomon
