#include "lab/compare/render_picture.h"

#include "base/error.h"
#include "lab/compare/row_pictures.h"
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
  const LabelledResult* judged;  // null: not yet

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
  return {toSrgb8(radiance), radiance, {{"R", "G", "B"}, "radiance, cd/m^2, times the exposure", true}, {}};
}

RenderedPicture grey(const Subject& subject, const std::vector<float>& values) {
  return {visibilityPicture(subject.receivers(), values),
          oneChannel(subject, values),
          {{"Y"}, "share of the light that arrives, 0 to 1"},
          {}};
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
  return {differencePicture(subject.receivers(), predicted, exact), values, {{"Y"}, "visibility - truth, -1 to 1"}, {}};
}

RenderedPicture labelled(const Subject& subject, const LabelImage& labels, const std::string& name) {
  const LightOnMap& lit = subject.lit;
  const std::string title = fmt::format("{} {}, {} x {} texels", lit.parameterization().name(), name,
                                        lit.fitted().map.width, lit.fitted().map.height);
  std::vector<float> numbers;
  for (const Label label : labels.labels) numbers.push_back(static_cast<float>(label));
  return {labelPicture(lit.receivers(), lit.truth(), labels, title),
          oneChannel(subject, numbers),
          {{"label"}, kLabelUnits},
          {}};
}

RenderedPicture labels(const Subject& subject) {
  const char* name = subject.method.bias->name;
  if (subject.judged != nullptr) return labelled(subject, subject.judged->labels, name);
  return labelled(subject, subject.lit.judge(subject.method).labels, name);
}

// Verdicts of a prediction; where nothing is scored none was asked for.
std::vector<Verdict> verdictsOf(const ImageF& prediction, const Receivers& receivers) {
  std::vector<Verdict> verdicts(receivers.states.size(), Verdict::NotAsked);
  for (size_t i = 0; i < verdicts.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    const float value = prediction.values[i * static_cast<size_t>(prediction.channels)];
    verdicts[i] = value >= 0.75f ? Verdict::Lit : value <= 0.25f ? Verdict::Shadow : Verdict::Uncovered;
  }
  return verdicts;
}

std::string countsText(const LabelImage& labels, const Receivers& receivers) {
  std::string text = fmt::format("of {} scored pixels", receivers.scored);
  for (const Label label :
       {Label::Agree, Label::Acne, Label::Leak, Label::EdgeShadow, Label::EdgeLight, Label::Uncovered})
    text += fmt::format("{} {} {}", label == Label::Agree ? ":" : ",", labelName(label), labels.count(label));
  return text;
}

RenderedPicture metres(const ImageF& depth) {
  return {depthPicture(depth), depth, {{"metres"}, "metres"}, {}};
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

// Which triangle each texel sees; as data its instance and its number in the mesh, counted from 1.
RenderedPicture ids(const Subject& subject) {
  LightOnMap& lit = subject.lit;
  if (!lit.parameterization().supportsBias(findBias("two-plane")))
    throw UsageError(
        fmt::format("--show ids: a {} map stores no triangles; choose another map", lit.parameterization().name()));
  const glsl::ShadowMap& shape = lit.fitted().map;
  const SceneBuffers& scene = lit.view().buffers();
  const std::vector<uint32_t> stored =
      lit.occluders(glsl::kChannelDepth | glsl::kChannelIds).downloadIds(lit.view().device());
  ImageF data(shape.width * shape.sliceCount, shape.height, 2);
  for (size_t i = 0; i < stored.size(); ++i) {
    const int x = static_cast<int>(i) % shape.width, row = static_cast<int>(i) / shape.width;
    const int slice = row / shape.height, y = row % shape.height;
    const glsl::PrimitiveId id = primitiveOf(scene.ids, scene.firstTriangles, stored[i]);
    float* values = data.at(slice * shape.width + x, y);
    values[0] = static_cast<float>(id.instancePlusOne);
    values[1] = id.instancePlusOne == 0 ? 0.0f : static_cast<float>(id.triangle + 1);
  }
  return {idPicture(data), data, {{"instance", "triangle"}, "number, from 1; 0 none"}, {}};
}

RenderedPicture texelDensity(const Subject& subject) {
  const LightOnMap& lit = subject.lit;
  const std::vector<float> densities = lit.texelDensities();
  const MapSetup& setup = lit.setup();
  const std::string title = fmt::format("{}, {} x {} x {} texels, fit {}, warp {}", lit.parameterization().name(),
                                        lit.fitted().map.sliceCount, setup.side, setup.side,
                                        setup.options.text(kWindowFit), setup.options.text(kWarp));
  return {densityPicture(lit.receivers(), densities, title),
          oneChannel(subject, densities),
          {{"texels_per_m2"}, "1/m^2"},
          {}};
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
                               ShowChoice{"ids", ids},
                               ShowChoice{"texel-density", texelDensity}};

}  // namespace

std::vector<std::string> picturesToShow() {
  std::vector<std::string> names;
  for (const ShowChoice& shown : kShown) names.emplace_back(shown.name);
  return names;
}

RenderedPicture drawPicture(LightOnMap& lit, const Method& method, const ChosenFilter& filter, const std::string& show,
                            const LabelledResult* judged) {
  const auto* const shown = std::ranges::find_if(kShown, [&](const ShowChoice& s) { return s.name == show; });
  if (shown == kShown.end()) throw UsageError(fmt::format("--show {}: no such picture", show));
  RenderedPicture picture = shown->draw({lit, method, filter, judged});
  picture.note = lit.fitted().note;
  if (picture.channels.isColour) picture.exposure = lit.exposureFactor();
  return picture;
}

RenderedPicture renderLabelsOf(const Session& session, const CompareOptions& options,
                               const std::filesystem::path& prediction) {
  const ImageF image = readImage(prediction);
  const glsl::CameraView& view = session.view();
  if (image.width != view.width || image.height != view.height)
    throw UsageError(fmt::format("--prediction {}: is {} x {} pixels, the picture {} x {}; give its --size",
                                 prediction.string(), image.width, image.height, view.width, view.height));
  const Parameterization& map = *options.maps.front();
  ShadowPasses passes(session);
  LightOnMap lit = openLight(session, passes, map, mapSetupOf(options, map));
  const Method method = methodFor(session, options, findBias("none"));
  // Without a bias that moves the look-up: the texel that holds the point.
  const std::vector<glsl::PixelDiagnosis> diagnosis = lit.diagnose(method);
  const std::vector<Verdict> verdicts = verdictsOf(image, lit.receivers());
  const LabelImage labels = labelPixels(session.tracer(), lit.light(), lit.receivers(), lit.truth(), verdicts,
                                        [&](size_t pixel) { return texelRayW(lit.fitted(), diagnosis[pixel].texel); });
  RenderedPicture picture = labelled({lit, method, filterFor(options, *options.filters.front()), nullptr}, labels,
                                     prediction.stem().string());
  picture.note = countsText(labels, lit.receivers());
  return picture;
}

RenderedPicture renderPicture(const Session& session, const CompareOptions& options, const std::string& show) {
  const Parameterization& map = *options.maps.front();
  ShadowPasses passes(session);
  LightOnMap lit = openLight(session, passes, map, mapSetupOf(options, map));
  const Method method = methodFor(session, options, *options.biases.front());
  return drawPicture(lit, method, filterFor(options, *options.filters.front()), show);
}

}  // namespace gnomon
