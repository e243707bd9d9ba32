#include "view/picture_worker.h"

#include "base/error.h"
#include "lab/compare/render_picture.h"
#include "lab/fog/fog_methods.h"
#include "lab/fog/fog_reference.h"
#include "lab/picture/pictures.h"
#include "lab/picture/unfold.h"
#include "omni/cube_map.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Sides of a picture while something moves, as shares of the full one: few, so that what is made for a size is made
// once.
constexpr std::array kShares = {1.0, 0.75, 0.5, 0.375, 0.25, 0.125};
// A larger size is tried where a picture takes less than this share of the budget.
constexpr double kRoomToGrow = 0.55;
// A picture of more pixels is counted at this share of its side before it is labelled in full.
constexpr int kLarge = 400'000;
constexpr double kEstimateShare = 0.5;
// What is kept of sizes that were drawn.
constexpr size_t kMostSizes = 4;

std::string sceneKey(const SetupOptions& setup) {
  SetupOptions scene;
  scene.scene = setup.scene;
  scene.gltf = setup.gltf;
  scene.choice = setup.choice;
  return fmt::format("{}", fmt::join(setupWords(scene), "\n"));
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

bool needsLabels(const ViewSide& side) {
  return side.show == "labels";
}

}  // namespace

// What the thread draws with; used by it alone.
class PictureWorker::Studio {
 public:
  explicit Studio(const gpu::DeviceOptions& options) : device_(gpu::Device::create(options)) {}

  const gpu::Device& device() const { return *device_; }
  const Tracer& tracer() const { return traced_->tracer; }

  void openScene(const ViewState& state) {
    const std::string key = sceneKey(state.setup);
    if (root_ && key == sceneKey_) return;
    const auto traced = std::make_shared<const TracedScene>(gnomon::openScene(state.setup));
    // Whatever is wrong with the new scene is said while the old one is still there.
    auto root =
        std::make_unique<SceneView>(device_, traced, chooseCamera(state.setup, traced->tracer), kRootSide, kRootSide);
    for (auto& [size, canvas] : canvases_) canvas.forgetView();
    root_ = std::move(root);
    traced_ = traced;
    sceneKey_ = key;
  }

  // The size at which the next picture is drawn.
  double shareFor(const PictureRequest& request) {
    if (!request.moving) return 1.0;
    return kShares[level_];
  }

  void learn(const PictureRequest& request, double share, double ms) {
    // At rest: a guess of where to begin, by pixels alone.
    if (!request.moving) {
      if (share == 1.0) restMs_ = ms;
      level_ = 0;
      while (level_ + 1 < kShares.size() && restMs_ * kShares[level_] * kShares[level_] > request.state.budgetMs)
        ++level_;
      return;
    }
    if (ms > 1.15 * request.state.budgetMs && level_ + 1 < kShares.size()) {
      ++level_;
      grewTooLarge_ = 60;
    } else if (ms < kRoomToGrow * request.state.budgetMs && level_ > 0 && grewTooLarge_ == 0) {
      --level_;
    }
    if (grewTooLarge_ > 0) --grewTooLarge_;
  }

  // `keepsOthers`: what other sizes hold is still of use.
  std::shared_ptr<ViewPicture> draw(const PictureRequest& request, double share, bool keepsOthers = false) {
    const ViewState& state = request.state;
    auto picture = std::make_shared<ViewPicture>();
    picture->number = request.number;
    picture->fullWidth = request.width;
    picture->fullHeight = request.height;
    picture->width = std::max(static_cast<int>(std::lround(request.width * share)), 1);
    picture->height = std::max(static_cast<int>(std::lround(request.height * share)), 1);
    picture->traced = traced_;
    Canvas& canvas = canvasFor(picture->width, picture->height);
    const auto stage = [&](const char* name, const auto& work) {
      const Clock::time_point start = Clock::now();
      work();
      picture->stages.push_back({name, msSince(start)});
    };
    stage("G-buffer", [&] { lookFrom(canvas, state); });
    picture->camera = canvas.view->view();
    for (size_t side = 0; side < (state.split ? 2u : 1u); ++side) {
      if (state.fog.on)
        drawFog(canvas, state, side, share, *picture, stage);
      else
        drawSide(canvas, state, side, *picture, stage);
    }
    canvas.used = ++uses_;
    // Maps of other sizes are of a light that has moved on.
    for (auto& [size, other] : canvases_)
      if (&other != &canvas && !keepsOthers)
        for (LightAndKey& light : other.lights) light = {};
    return picture;
  }

  // Counts of a picture of fewer pixels: a large one is not labelled at once.
  void estimate(const PictureRequest& request, ViewPicture& picture) {
    PictureRequest coarse = request;
    coarse.state.split = request.state.split;
    for (ViewSide& side : coarse.state.sides) side.show = "labels";
    const std::shared_ptr<ViewPicture> counted = draw(coarse, kEstimateShare, true);
    for (size_t side = 0; side < (request.state.split ? 2u : 1u); ++side) {
      const Canvas& canvas = canvasFor(counted->width, counted->height);
      picture.sides[side].counts = ViewCounts{.labels = counted->sides[side].judged->labels.counts,
                                              .scored = canvas.lights[side].lit->receivers().scored,
                                              .share = kEstimateShare};
    }
  }

  // The rest of what is known of a picture at rest.
  // False where `overtaken` said so: it is then not whole.
  bool refine(const PictureRequest& request, ViewPicture& picture, const std::function<bool()>& overtaken) {
    const ViewState& state = request.state;
    Canvas& canvas = canvasFor(picture.width, picture.height);
    if (state.fog.on) return true;
    for (size_t side = 0; side < (state.split ? 2u : 1u); ++side) {
      SidePicture& drawn = picture.sides[side];
      LightOnMap& lit = *canvas.lights[side].lit;
      const Method method = methodFor(*canvas.view, state.sides[side].options, *drawn.bias);
      if (!drawn.judged) drawn.judged = lit.judge(method);
      drawn.counts = ViewCounts{.labels = drawn.judged->labels.counts, .scored = lit.receivers().scored};
      if (side == 0) picture.exact = lit.keptTruth();
      drawn.fitted = lit.fitted();
      if (overtaken()) return false;
      const bool isUnfolded = state.unfolded && side == 0;
      if (!state.loupe && !isUnfolded) continue;
      drawn.diagnosis = lit.diagnose(method);
      drawn.depths = depthInMetres(*device_, lit.occluders(drawn.bias->channels));
      if (overtaken()) return false;
      if (isUnfolded) drawn.unfolded = unfoldedPicture(depthPicture(drawn.depths->first), lit.fitted(), {64, 48, 64});
    }
    picture.counted = true;
    return true;
  }

  // By ray tracing, for sides that show it; the picture is then replaced.
  bool wantsReference(const ViewState& state) const {
    if (!state.fog.on) return false;
    return state.sides[0].integrator == kReferenceIntegrator ||
           (state.split && state.sides[1].integrator == kReferenceIntegrator);
  }
  void traceReference(const PictureRequest& request, ViewPicture& picture) {
    const ViewState& state = request.state;
    Canvas& canvas = canvasFor(picture.width, picture.height);
    MediaReferenceOptions options;
    options.bound = state.fog.density.empty() ? 0.001 : 0.003;
    for (size_t side = 0; side < (state.split ? 2u : 1u); ++side) {
      if (state.sides[side].integrator != kReferenceIntegrator) continue;
      const KeptReference kept = referenceFor(*canvas.view, *canvas.fog, options, true);
      exposeFog(*canvas.fog, kept.reference.inScattered, state.sides[side], picture.sides[side]);
    }
  }

 private:
  static constexpr int kRootSide = 8;  // pixels

  struct LightAndKey {
    std::string key;
    std::unique_ptr<LightOnMap> lit;
  };
  // What is kept of a size.
  struct Canvas {
    std::unique_ptr<ShadowPasses> passes;
    std::unique_ptr<MediaPass> media;
    std::unique_ptr<SceneView> view;
    std::string camera;
    std::array<LightAndKey, kSideCount> lights;
    std::optional<FogView> fog;
    std::string fogKey;
    uint64_t used = 0;

    void forgetView() {
      for (LightAndKey& light : lights) light = {};
      fog.reset();
      fogKey.clear();
      view.reset();
    }
  };

  Canvas& canvasFor(int width, int height) {
    const std::pair size(width, height);
    if (canvases_.contains(size)) return canvases_[size];
    while (canvases_.size() >= kMostSizes) {
      const auto oldest = std::ranges::min_element(
          canvases_, [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
      canvases_.erase(oldest);
    }
    Canvas& canvas = canvases_[size];
    canvas.used = ++uses_;
    return canvas;
  }

  void lookFrom(Canvas& canvas, const ViewState& state) {
    // Where no camera is named, the light may decide where one stands.
    const bool follows = state.setup.camera.empty() && traced_->scene.cameras.empty();
    const std::string camera = follows ? "\n" + state.setup.light : state.setup.camera;
    if (canvas.view && camera == canvas.camera) return;
    const Camera chosen = chooseCamera(state.setup, traced_->tracer);
    const auto [width, height] = sizeOf(canvas);
    auto view = std::make_unique<SceneView>(*root_, chosen, width, height);
    canvas.forgetView();
    canvas.view = std::move(view);
    canvas.camera = camera;
    if (!canvas.passes) canvas.passes = std::make_unique<ShadowPasses>(*canvas.view);
  }

  std::pair<int, int> sizeOf(const Canvas& canvas) const {
    for (const auto& [size, one] : canvases_)
      if (&one == &canvas) return size;
    return {1, 1};
  }

  LightOnMap& lightFor(Canvas& canvas, const ViewState& state, size_t side, ViewPicture& picture) {
    const CompareOptions& options = state.sides[side].options;
    const Parameterization& map = *options.maps.front();
    LightAndKey& kept = canvas.lights[side];
    const std::string key = lightKey(state, options);
    picture.light = chooseLight(state.setup, traced_->tracer, map);
    if (kept.lit && kept.key == key) return *kept.lit;
    kept = {};
    auto lit = std::make_unique<LightOnMap>(*canvas.view, *canvas.passes, map, picture.light, mapSetupOf(options, map));
    for (const LightAndKey& other : canvas.lights)
      if (other.lit) lit->shareTruth(*other.lit);
    if (lit->receivers().scored == 0)
      throw WorldError(fmt::format("light '{}': the camera sees no surface that faces the light; move one of them",
                                   picture.light.name));
    kept.lit = std::move(lit);
    kept.key = key;
    return *kept.lit;
  }

  template <typename Stage>
  void drawSide(Canvas& canvas, const ViewState& state, size_t side, ViewPicture& picture, const Stage& stage) {
    const ViewSide& asked = state.sides[side];
    SidePicture& drawn = picture.sides[side];
    const BiasMethod& bias = *asked.options.biases.front();
    drawn.map = asked.options.maps.front();
    drawn.bias = &bias;
    LightOnMap* lit = nullptr;
    stage(side == 0 ? "truth A" : "truth B", [&] { lit = &lightFor(canvas, state, side, picture); });
    stage(side == 0 ? "fit A" : "fit B", [&] { lit->fitted(); });
    stage(side == 0 ? "map A" : "map B", [&] { lit->occluders(bias.channels); });
    const Method method = methodFor(*canvas.view, asked.options, bias);
    drawn.params = method.params;
    stage(side == 0 ? "picture A" : "picture B", [&] {
      if (needsLabels(asked)) drawn.judged = lit->judge(method);
      RenderedPicture made = drawPicture(*lit, method, filterFor(asked.options, *asked.options.filters.front()),
                                         asked.show, drawn.judged ? &*drawn.judged : nullptr);
      drawn.image = std::move(made.png);
      drawn.exposure = made.exposure;
      if (!made.note.empty()) picture.note = made.note;
    });
  }

  static void exposeFog(const FogView& view, const ImageF& inScattered, const ViewSide& asked, SidePicture& drawn) {
    const bool whole = asked.show != "medium";
    const FogExposure exposure = asked.options.exposure ? FogExposure{*asked.options.exposure}
                                 : whole                ? exposureFor(view, inScattered)
                                                        : mediumExposureFor(inScattered);
    drawn.image = exposed(whole ? composed(view, inScattered) : inScattered, exposure);
    drawn.exposure = static_cast<double>(exposure.factor);
  }

  const FogView& fogFor(Canvas& canvas, const ViewState& state, ViewPicture& picture) {
    const FogState& fog = state.fog;
    const std::string place =
        fog.densityAt ? fmt::format("{},{},{}", fog.densityAt->x, fog.densityAt->y, fog.densityAt->z) : "";
    const std::string density = fmt::format("{}\n{}\n{}\n{}", fog.density, place, fog.densityScale, fog.densityTurn);
    const SetupOptions& setup = state.setup;
    picture.light = chooseLight(setup, traced_->tracer, volumeParameterization());
    const std::string key =
        fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", density, fog.sigmaS, fog.sigmaA, fog.g, fog.ambient,
                    setup.light, setup.direction, setup.coneDegrees.value_or(0.0), setup.intensity.value_or(0.0));
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

  template <typename Stage>
  void drawFog(Canvas& canvas, const ViewState& state, size_t side, double share, ViewPicture& picture,
               const Stage& stage) {
    const ViewSide& asked = state.sides[side];
    const FogView* view = nullptr;
    stage(side == 0 ? "surfaces" : "surfaces B", [&] { view = &fogFor(canvas, state, picture); });
    const bool dense = view->density != nullptr;
    // The reference's place is held by the first integrator until it is traced.
    const Integrator* chosen =
        asked.integrator == kReferenceIntegrator ? &integrators().front() : &findIntegrator(asked.integrator);
    const Integrator* integrator = dense ? &integratorInDensity(*chosen) : chosen;
    const Parameterization& map = *asked.options.maps.front();
    MapOptions options = asked.options.mapOptions;
    for (double s = share; s < 1.0 && s > 0.0; s *= 2.0) options = volumeParameterization().halved(options);
    const FogMethodOptions how{
        .methods = {{.integrator = integrator, .steps = dense || integrator->takesSteps ? asked.steps : 0}},
        .marchMap = map.looksAround() ? &map : &findMarchMap(),
        .map = options,
        .mapSide = asked.options.mapSide,
        .cull = asked.options.cull,
        .repeats = 0};
    stage(side == 0 ? "medium A" : "medium B", [&] {
      if (!canvas.media)
        canvas.media = std::make_unique<MediaPass>(*device_, canvas.view->view().width, canvas.view->view().height);
      const std::vector<FogMethodResult> made = runFogMethods(*canvas.view, *canvas.passes, *canvas.media, *view, how);
      exposeFog(*view, made.front().inScattered, asked, picture.sides[side]);
    });
  }

  static const Parameterization& findMarchMap();

  std::shared_ptr<const gpu::Device> device_;
  std::shared_ptr<const TracedScene> traced_;
  std::unique_ptr<SceneView> root_;  // holds what is on the device of the scene
  std::string sceneKey_;
  std::map<std::pair<int, int>, Canvas> canvases_;
  std::shared_ptr<const DensityGrid> density_;
  std::string densityKey_;
  uint64_t uses_ = 0;
  size_t level_ = 0;  // of kShares
  int grewTooLarge_ = 0;
  double restMs_ = 0.0;
};

const Parameterization& PictureWorker::Studio::findMarchMap() {
  return cubeParameterization();
}

PictureWorker::PictureWorker(const gpu::DeviceOptions& device, std::function<void()> onPicture)
    : device_(device), onPicture_(std::move(onPicture)), thread_([this] { run(); }) {}

PictureWorker::~PictureWorker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PictureWorker::ask(PictureRequest request) {
  {
    const std::lock_guard lock(mutex_);
    asked_ = std::move(request);
  }
  wake_.notify_all();
}

std::shared_ptr<const ViewPicture> PictureWorker::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

bool PictureWorker::isIdle() const {
  const std::lock_guard lock(mutex_);
  return !busy_ && !asked_;
}

size_t PictureWorker::validationMessages() const {
  const std::lock_guard lock(mutex_);
  return validationMessages_;
}

void PictureWorker::loseDevice() {
  const std::lock_guard lock(mutex_);
  loses_ = true;
}

void PictureWorker::run() {
  std::unique_ptr<Studio> studio;
  const auto publish = [&](std::shared_ptr<const ViewPicture> picture) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = std::move(picture);
      if (studio) validationMessages_ = studio->device().validationMessages().size();
    }
    onPicture_();
  };
  const auto overtaken = [&] {
    const std::lock_guard lock(mutex_);
    return asked_.has_value() || ends_;
  };
  // While the window is being made; what is wrong is told with the first picture.
  try {
    studio = std::make_unique<Studio>(device_);
  } catch (const std::exception&) {
  }
  while (true) {
    PictureRequest request;
    {
      std::unique_lock lock(mutex_);
      busy_ = false;
      wake_.wait(lock, [&] { return asked_ || ends_; });
      if (ends_) return;
      request = std::move(*asked_);
      asked_.reset();
      busy_ = true;
      if (loses_) studio.reset();
      loses_ = false;
    }
    // What went wrong, over the last good picture.
    const auto complain = [&](const std::string& problem, bool ofScene) {
      const std::shared_ptr<const ViewPicture> last = newest();
      auto picture = last ? std::make_shared<ViewPicture>(*last) : std::make_shared<ViewPicture>();
      picture->number = request.number;
      picture->problem = problem;
      picture->sceneFailed = ofScene;
      picture->refined = true;
      publish(picture);
    };
    bool inScene = true;
    try {
      if (!studio) studio = std::make_unique<Studio>(device_);
      const Clock::time_point start = Clock::now();
      studio->openScene(request.state);
      inScene = false;
      chooseMapsByLight(request.state, studio->tracer());
      const double share = studio->shareFor(request);
      const Clock::time_point drawing = Clock::now();
      std::shared_ptr<ViewPicture> picture = studio->draw(request, share);
      studio->learn(request, share, msSince(drawing));
      picture->stages.push_back({"all", msSince(start)});
      const bool wantsReference = studio->wantsReference(request.state);
      picture->refined = false;
      publish(picture);
      if (request.moving || overtaken()) continue;
      const bool needsEstimate =
          !request.state.fog.on && picture->width * picture->height > kLarge &&
          std::ranges::none_of(picture->sides, [](const SidePicture& s) { return s.judged.has_value(); });
      if (needsEstimate) {
        picture = std::make_shared<ViewPicture>(*picture);
        studio->estimate(request, *picture);
        publish(picture);
        if (overtaken()) continue;
      }
      auto refined = std::make_shared<ViewPicture>(*picture);
      if (!studio->refine(request, *refined, overtaken)) continue;
      refined->stages.push_back({"labels", msSince(start) - picture->stages.back().ms});
      refined->refined = !wantsReference;
      publish(refined);
      if (!wantsReference || overtaken()) continue;
      auto exact = std::make_shared<ViewPicture>(*refined);
      studio->traceReference(request, *exact);
      exact->refined = true;
      publish(exact);
    } catch (const std::bad_alloc&) {
      complain("out of memory; take a smaller picture or map", inScene);
    } catch (const std::exception& error) {
      complain(error.what(), inScene);
      // Nothing made on a device that is lost is worth keeping; the next picture makes all anew.
      if (std::string(error.what()).find("VK_ERROR_DEVICE_LOST") != std::string::npos) studio.reset();
    }
  }
}

}  // namespace gnomon
