#include "view/picture_studio.h"

#include "base/error.h"
#include "lab/compare/render_picture.h"
#include "lab/fog/fog_methods.h"
#include "lab/fog/fog_reference.h"
#include "lab/picture/pictures.h"
#include "lab/picture/unfold.h"
#include "omni/cube_map.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtx/component_wise.hpp>

namespace gnomon {

namespace {

constexpr int kLeastMapSide = 64;  // texels, of a map that is halved while something moves
// A picture of more pixels is counted at this share of its side before it is labelled in full.
constexpr int kLarge = 400'000;
constexpr double kEstimateShare = 0.5;
// Of the view that holds what is on the device of a scene, pixels.
constexpr int kRootSide = 8;
// What is kept of sizes that were drawn.
constexpr size_t kMostSizes = 4;
// And of methods, whose pipelines stay, in all of them: a pipeline is one to two MiB of a CPU's code.
constexpr size_t kMostMethods = 40;

std::string sceneKey(const SetupOptions& setup) {
  SetupOptions scene;
  scene.scene = setup.scene;
  scene.gltf = setup.gltf;
  scene.choice = setup.choice;
  return fmt::format("{}", fmt::join(setupWords(scene), "\n"));
}

CompareOptions halved(CompareOptions options, int halvings) {
  const Parameterization& map = *options.maps.front();
  options.mapSide = mapSideOf(options, map);
  options.mapTexels = 0;
  for (int i = 0; i < halvings && options.mapSide >= 2 * kLeastMapSide; ++i) {
    options.mapSide /= 2;
    options.mapOptions = map.halved(options.mapOptions);
  }
  return options;
}

// What a light on a map is made of, beside the view.
std::string lightKey(const ViewState& state, const CompareOptions& options) {
  const SetupOptions& setup = state.setup;
  std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", setup.light, setup.direction,
                                setup.coneDegrees.value_or(0.0), setup.intensity.value_or(0.0),
                                options.maps.front()->name(), mapSideOf(options, *options.maps.front()),
                                cullModeName(options.cull), options.exposure.value_or(0.0f));
  for (const ChosenOption& choice : options.mapOptions.choices())
    key += fmt::format("\n{} {}", choice.option->name(), choice.option->textOf(choice.value));
  return key;
}

std::string methodKey(const ViewState& state, size_t side) {
  const ViewSide& asked = state.sides[side];
  const CompareOptions& options = asked.options;
  return fmt::format("{} {} {} {} {} {}", state.fog.on, options.maps.front()->name(), options.biases.front()->name,
                     options.filters.front()->name, asked.integrator, asked.show);
}

// Whatever pipelines depend on, and what a picture takes.
std::string rehearsalKey(const PictureRequest& request) {
  const ViewState& state = request.state;
  std::string key = fmt::format("{} {} {} {} {} {}", sceneKey(state.setup), request.width, request.height, state.split,
                                state.fog.on, state.budgetMs);
  for (const ViewSide& side : state.sides) {
    const CompareOptions& options = side.options;
    key += fmt::format("\n{} {} {} {} {} {} {}", side.show, options.maps.front()->name(),
                       mapSideOf(options, *options.maps.front()), options.biases.front()->name,
                       options.filters.front()->name, side.integrator, side.steps);
  }
  return key;
}

// Whether a map that was fitted to what another camera saw holds for what this one sees.
bool covers(const FittedMap& fitted, const Receivers& receivers) {
  const glm::dvec3 originW(fitted.frame.originW);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    const glm::dvec3 away = glm::abs(receivers.samples[i].positionW - originW);
    const double distance = fitted.map.kind == glsl::kMapCube ? glm::compMax(away) : glm::length(away);
    if (distance > static_cast<double>(fitted.zFar)) return false;
  }
  return true;
}

size_t sideCount(const ViewState& state) {
  return state.split ? 2 : 1;
}

void exposeFog(const FogView& view, const ImageF& inScattered, const ViewSide& asked, SidePicture& drawn) {
  const bool whole = asked.show != "medium";
  const FogExposure exposure = asked.options.exposure ? FogExposure{*asked.options.exposure}
                               : whole                ? exposureFor(view, inScattered)
                                                      : mediumExposureFor(inScattered);
  drawn.image = exposed(whole ? composed(view, inScattered) : inScattered, exposure);
  drawn.exposure = static_cast<double>(exposure.factor);
}

}  // namespace

void PictureStudio::Canvas::markStale() {
  // Unless that is too much to keep.
  constexpr int kMostSide = 2048;
  for (LightAndKey& light : lights) {
    light.isStale = true;
    if (light.lit && light.lit->setup().side > kMostSide) light = {};
  }
  fog.reset();
  fogKey.clear();
}

PictureStudio::PictureStudio(const gpu::DeviceOptions& options) : device_(gpu::Device::create(options)) {}

void PictureStudio::openScene(const ViewState& state) {
  const std::string key = sceneKey(state.setup);
  if (root_ && key == sceneKey_) return;
  const auto traced = std::make_shared<const TracedScene>(gnomon::openScene(state.setup));
  // Whatever is wrong with the new scene is said while the old one is still there.
  auto root =
      std::make_unique<SceneView>(device_, traced, chooseCamera(state.setup, traced->tracer), kRootSide, kRootSide);
  canvases_.clear();
  root_ = std::move(root);
  traced_ = traced;
  sceneKey_ = key;
}

// ---- how much is drawn ----

PictureStudio::Detail PictureStudio::detailFor(const PictureRequest& request) const {
  if (!request.moving) return {};
  Detail detail{.share = moving_.share(), .halvings = moving_.halvings()};
  const ViewState& state = request.state;
  detail.wholeScene =
      !state.fog.on && cameraOf(state) != restCamera_ && state.setup.light == restLight_ &&
      std::ranges::all_of(state.sides, [](const ViewSide& side) { return side.options.maps.front()->looksAround(); });
  // Drawn once, such a map is kept.
  if (detail.wholeScene) detail.halvings = 0;
  return detail;
}

void PictureStudio::learn(const PictureRequest& request, const ViewPicture& picture) {
  if (!request.moving) {
    restCamera_ = cameraOf(request.state);
    restLight_ = request.state.setup.light;
  }
  if (madeAnything_) return;  // what is made once is no measure
  PictureTimes times;
  for (const ViewStage& stage : picture.stages) {
    times.all += stage.ms;
    if (stage.isOfMap) times.maps += stage.ms;
  }
  if (request.moving)
    moving_.follow(request.state.budgetMs, times);
  else
    moving_.begin(request.state.budgetMs, times);
}

void PictureStudio::rehearse(const PictureRequest& request, const std::function<bool()>& overtaken) {
  const std::string key = rehearsalKey(request);
  if (key == rehearsed_) return;
  rehearsed_ = key;
  PictureRequest again = request;
  learn(again, *draw(again, {.anew = true, .keepsOthers = true}));
  again.moving = true;
  // Until what is drawn is what was learnt; each size is made by its first picture and measured by its second.
  constexpr int kMost = 6;
  double share = 0.0;
  for (int i = 0; i < kMost && share != moving_.share() && !overtaken(); ++i) {
    share = moving_.share();
    for (int twice = 0; twice < 2 && !overtaken(); ++twice) {
      const Detail detail{.share = share, .halvings = moving_.halvings(), .anew = true, .keepsOthers = true};
      learn(again, *draw(again, detail));
    }
  }
  moving_.forgetPatience();
}

// ---- drawing ----

std::shared_ptr<ViewPicture> PictureStudio::draw(const PictureRequest& request) {
  const Detail detail = detailFor(request);
  std::shared_ptr<ViewPicture> picture = draw(request, detail);
  learn(request, *picture);
  return picture;
}

std::shared_ptr<ViewPicture> PictureStudio::draw(const PictureRequest& request, const Detail& detail) {
  const ViewState& state = request.state;
  auto picture = std::make_shared<ViewPicture>();
  picture->number = request.number;
  picture->fullWidth = request.width;
  picture->fullHeight = request.height;
  picture->width = std::max(static_cast<int>(std::lround(request.width * detail.share)), 1);
  picture->height = std::max(static_cast<int>(std::lround(request.height * detail.share)), 1);
  picture->mapHalvings = detail.halvings;
  picture->traced = traced_;
  Canvas& canvas = canvasFor(picture->width, picture->height);
  forgetMethods(canvas);
  for (size_t side = 0; side < sideCount(state); ++side) canvas.methods.insert(methodKey(state, side));
  madeAnything_ = canvas.view == nullptr;
  const Sheet first{canvas, state, 0, detail, *picture};
  first.stage("G-buffer", "", [&] { lookFrom(canvas, state, picture->width, picture->height, detail.anew); });
  picture->camera = canvas.view->view();
  for (size_t side = 0; side < sideCount(state); ++side) {
    const Sheet sheet{canvas, state, side, detail, *picture};
    state.fog.on ? drawFog(sheet) : drawSide(sheet);
  }
  canvas.view->groundTruths().keepNewest(2 * kSideCount);
  // Maps of other sizes are of a light that has moved on.
  for (auto& [size, other] : canvases_)
    if (&other != &canvas && !detail.keepsOthers) other.markStale();
  return picture;
}

bool PictureStudio::needsEstimate(const PictureRequest& request, const ViewPicture& picture) {
  return !request.state.fog.on && picture.width * picture.height > kLarge &&
         std::ranges::none_of(picture.sides, [](const SidePicture& side) { return side.judged.has_value(); });
}

void PictureStudio::estimate(const PictureRequest& request, ViewPicture& picture) {
  PictureRequest coarse = request;
  for (ViewSide& side : coarse.state.sides) side.show = "labels";
  const std::shared_ptr<ViewPicture> counted = draw(coarse, {.share = kEstimateShare, .keepsOthers = true});
  const Canvas& canvas = canvasFor(counted->width, counted->height);
  for (size_t side = 0; side < sideCount(request.state); ++side)
    picture.sides[side].counts = ViewCounts{.labels = counted->sides[side].judged->labels.counts,
                                            .scored = canvas.lights[side].lit->receivers().scored,
                                            .share = kEstimateShare};
}

bool PictureStudio::refine(const PictureRequest& request, ViewPicture& picture,
                           const std::function<bool()>& overtaken) {
  const ViewState& state = request.state;
  Canvas& canvas = canvasFor(picture.width, picture.height);
  if (state.fog.on) return true;
  for (size_t side = 0; side < sideCount(state); ++side) {
    SidePicture& drawn = picture.sides[side];
    LightOnMap& lit = *canvas.lights[side].lit;
    const Method method = methodFor(*canvas.view, state.sides[side].options, *drawn.bias);
    if (!drawn.judged) drawn.judged = lit.judge(method);
    drawn.counts = ViewCounts{.labels = drawn.judged->labels.counts, .scored = lit.receivers().scored};
    drawn.exact = lit.view().groundTruths().of(lit.view(), lit.source(), lit.light());
    drawn.fitted = lit.fitted();
    if (overtaken()) return false;
    const bool isUnfolded = state.unfolded && side == 0;
    if (!state.loupe && !isUnfolded) continue;
    drawn.diagnosis = lit.diagnose(method);
    drawn.depths = depthInMetres(*device_, lit.occluders(drawn.bias->channels | glsl::kChannelDepth));
    if (overtaken()) return false;
    const DepthImages& depths = *drawn.depths;
    const ImageF& layer = state.secondLayer && depths.second ? *depths.second : depths.first;
    if (isUnfolded) drawn.unfolded = unfoldedPicture(depthPicture(layer), lit.fitted(), {64, 48, 64});
    if ((drawn.bias->channels & glsl::kChannelIds) != 0) {
      const SceneBuffers& scene = canvas.view->buffers();
      const std::vector<uint32_t> ids = lit.occluders(drawn.bias->channels).downloadIds(*device_);
      const glsl::ShadowMap& map = lit.fitted().map;
      for (const glsl::PixelDiagnosis& pixel : drawn.diagnosis) {
        const glm::ivec2 texel = glsl::unpackTexel(pixel.texel);
        const size_t row = static_cast<size_t>(glsl::unpackSlice(pixel.texel) * map.height + texel.y);
        const size_t index = row * static_cast<size_t>(map.width) + static_cast<size_t>(texel.x);
        const uint32_t id = index < ids.size() ? ids[index] : glsl::kNoId;
        drawn.held.push_back(primitiveOf(scene.ids, scene.firstTriangles, id));
      }
    }
  }
  picture.counted = true;
  return true;
}

bool PictureStudio::wantsReference(const ViewState& state) {
  if (!state.fog.on) return false;
  return state.sides[0].integrator == kReferenceIntegrator ||
         (state.split && state.sides[1].integrator == kReferenceIntegrator);
}

void PictureStudio::traceReference(const PictureRequest& request, ViewPicture& picture) {
  const ViewState& state = request.state;
  Canvas& canvas = canvasFor(picture.width, picture.height);
  MediaReferenceOptions options;
  options.bound = state.fog.density.empty() ? 0.001 : 0.003;
  for (size_t side = 0; side < sideCount(state); ++side) {
    if (state.sides[side].integrator != kReferenceIntegrator) continue;
    const KeptReference kept = referenceFor(*canvas.view, *canvas.fog, options, true);
    exposeFog(*canvas.fog, kept.reference.inScattered, state.sides[side], picture.sides[side]);
  }
}

PictureStudio::Canvas& PictureStudio::canvasFor(int width, int height) {
  const std::pair size(width, height);
  while (!canvases_.contains(size) && canvases_.size() >= kMostSizes) forgetOldestSize();
  Canvas& canvas = canvases_[size];
  canvas.used = ++uses_;
  return canvas;
}

void PictureStudio::forgetOldestSize() {
  const auto oldest =
      std::ranges::min_element(canvases_, [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
  canvases_.erase(oldest);
}

// The newest two sizes stay: one of them may be the coarse picture that the other is counted by.
void PictureStudio::forgetMethods(Canvas& drawn) {
  const auto kept = [&] {
    size_t count = 0;
    for (const auto& [size, canvas] : canvases_) count += canvas.methods.size();
    return count;
  };
  while (kept() > kMostMethods && canvases_.size() > 2) forgetOldestSize();
  if (drawn.methods.size() > kMostMethods / 2) drawn = {.used = drawn.used};
}

// Where no camera is named, the light may decide where one stands.
std::string PictureStudio::cameraOf(const ViewState& state) const {
  const bool follows = state.setup.camera.empty() && traced_->scene.cameras.empty();
  return follows ? "\n" + state.setup.light : state.setup.camera;
}

void PictureStudio::lookFrom(Canvas& canvas, const ViewState& state, int width, int height, bool anew) {
  const std::string camera = cameraOf(state);
  if (canvas.view && camera == canvas.camera && !anew) return;
  const Camera chosen = chooseCamera(state.setup, traced_->tracer);
  canvas.markStale();
  if (canvas.view) {
    canvas.view->lookFrom(chosen);
  } else {
    canvas.view = std::make_unique<SceneView>(*root_, chosen, width, height);
    canvas.passes = std::make_unique<ShadowPasses>(*canvas.view);
  }
  canvas.camera = camera;
}

LightOnMap& PictureStudio::lightFor(const Sheet& sheet) {
  const auto& [canvas, state, side, detail, picture] = sheet;
  const CompareOptions options = halved(sheet.asked().options, detail.halvings);
  const Parameterization& map = *options.maps.front();
  LightAndKey& kept = canvas.lights[side];
  LightAndKey& other = canvas.lights[1 - side];
  const std::string key = lightKey(state, options);
  picture.light = chooseLight(state.setup, traced_->tracer, map);
  const bool anyFit = detail.wholeScene;
  const auto isIt = [&](const LightAndKey& one) {
    return one.lit && one.key == key && !one.isStale && (!one.isLoose || anyFit);
  };
  if (isIt(kept)) return *kept.lit;
  if (side == 1 && isIt(other)) {
    kept = other;
    return *kept.lit;
  }
  MapSetup setup = mapSetupOf(options, map);
  if (detail.wholeScene) setup.receiversW.emplace();
  auto lit = std::make_shared<LightOnMap>(*canvas.view, *canvas.passes, map, picture.light, std::move(setup));
  if (lit->receivers().scored == 0)
    throw WorldError(fmt::format("light '{}': the camera sees no surface that faces the light; move one of them",
                                 picture.light.name));
  const bool isShared = kept.lit && kept.lit == other.lit;
  if (isShared && side == 0) other = {};
  // What A has in this picture stays A's.
  if (kept.lit && !(isShared && side == 1) && &kept.lit->parameterization() == &map) {
    // A map around the light is the same for every camera.
    const bool isSame = detail.wholeScene && !detail.anew && kept.key == key && kept.lit->light() == lit->light() &&
                        covers(kept.lit->fitted(), lit->receivers());
    isSame ? lit->takeMapOf(*kept.lit) : lit->takeRoomOf(*kept.lit);
    madeAnything_ = madeAnything_ || (detail.wholeScene && !isSame);
  }
  kept = {.key = key, .lit = std::move(lit), .isLoose = detail.wholeScene};
  return *kept.lit;
}

void PictureStudio::drawSide(const Sheet& sheet) {
  const ViewSide& asked = sheet.asked();
  SidePicture& drawn = sheet.drawn();
  const BiasMethod& bias = *asked.options.biases.front();
  drawn.map = asked.options.maps.front();
  drawn.bias = &bias;
  LightOnMap* lit = nullptr;
  sheet.stage("truth A", "truth B", [&] {
    lit = &lightFor(sheet);
    lit->truth();
  });
  sheet.stage("fit A", "fit B", [&] { lit->fitted(); });
  sheet.stage(
      "map A", "map B", [&] { lit->occluders(bias.channels); }, true);
  const Method method = methodFor(*sheet.canvas.view, asked.options, bias);
  drawn.params = method.params;
  sheet.stage("picture A", "picture B", [&] {
    if (asked.show == "labels") drawn.judged = lit->judge(method);
    RenderedPicture made = drawPicture(*lit, method, filterFor(asked.options, *asked.options.filters.front()),
                                       asked.show, drawn.judged ? &*drawn.judged : nullptr);
    drawn.image = std::move(made.png);
    drawn.exposure = made.exposure;
    if (!made.note.empty()) sheet.picture.note = made.note;
  });
}

// ---- fog ----

const FogView& PictureStudio::fogFor(const Sheet& sheet) {
  const auto& [canvas, state, side, detail, picture] = sheet;
  const FogState& fog = state.fog;
  const std::string place =
      fog.densityAt ? fmt::format("{},{},{}", fog.densityAt->x, fog.densityAt->y, fog.densityAt->z) : "";
  const std::string density = fmt::format("{}\n{}\n{}\n{}", fog.density, place, fog.densityScale, fog.densityTurn);
  const SetupOptions& setup = state.setup;
  picture.light = chooseLight(setup, traced_->tracer, volumeParameterization());
  const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", density, fog.sigmaS.value_or(-1.0),
                                      fog.sigmaA, fog.g, fog.ambient, setup.light, setup.direction,
                                      setup.coneDegrees.value_or(0.0), setup.intensity.value_or(0.0));
  if (canvas.fog && canvas.fogKey == key) return *canvas.fog;
  canvas.fog.reset();
  FogState homogeneous = fog;
  homogeneous.density.clear();
  FogMedium medium = fogMediumOf(homogeneous, traced_->scene.originW);
  if (!fog.density.empty()) {
    if (!density_ || density != densityKey_) density_ = fogMediumOf(fog, traced_->scene.originW).density;
    densityKey_ = density;
    medium.density = density_;
  }
  canvas.fog = lookIntoFog(*canvas.view, *canvas.passes, {picture.light}, medium);
  canvas.fogKey = key;
  return *canvas.fog;
}

void PictureStudio::drawFog(const Sheet& sheet) {
  const ViewSide& asked = sheet.asked();
  Canvas& canvas = sheet.canvas;
  const FogView* view = nullptr;
  sheet.stage("surfaces", "surfaces B", [&] { view = &fogFor(sheet); });
  const bool dense = view->density != nullptr;
  // The reference's place is held by the first integrator until it is traced.
  const Integrator* chosen =
      asked.integrator == kReferenceIntegrator ? &integrators().front() : &findIntegrator(asked.integrator);
  const Integrator* integrator = dense ? &integratorInDensity(*chosen) : chosen;
  const Parameterization& map = *asked.options.maps.front();
  // Of fewer pixels fewer voxels are seen.
  MapOptions options = asked.options.mapOptions;
  for (double s = sheet.detail.share; s < 1.0; s *= 2.0) options = volumeParameterization().halved(options);
  const FogMethodOptions how{
      .methods = {{.integrator = integrator, .steps = dense || integrator->takesSteps ? asked.steps : 0}},
      .marchMap = map.looksAround() ? &map : &cubeParameterization(),
      .map = options,
      .mapSide = halved(asked.options, sheet.detail.halvings).mapSide,
      .cull = asked.options.cull,
      .repeats = 0};
  sheet.stage("medium A", "medium B", [&] {
    madeAnything_ = madeAnything_ || !canvas.media;
    if (!canvas.media)
      canvas.media = std::make_unique<MediaPass>(*device_, canvas.view->view().width, canvas.view->view().height);
    const std::vector<FogMethodResult> made = runFogMethods(*canvas.view, *canvas.passes, *canvas.media, *view, how);
    exposeFog(*view, made.front().inScattered, asked, sheet.drawn());
  });
}

}  // namespace gnomon
