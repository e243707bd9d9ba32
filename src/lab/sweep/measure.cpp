#include "lab/sweep/measure.h"

#include "base/error.h"
#include "base/image_png.h"
#include "base/interrupt.h"
#include "judge/filtered_truth.h"
#include "lab/compare/compare_command.h"
#include "lab/compare/method_row.h"
#include "lab/compare/robustness.h"
#include "lab/compare/tune.h"
#include "lab/fog/fog_measure.h"
#include "lab/fog/fog_reference.h"
#include "lab/picture/pictures.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kWorstScale = 4;  // pixels of a picture a pixel

// A square of an image, enlarged, into another.
void paste(const Image8& from, const WorstPlace& place, Image8& to, int left) {
  for (int y = 0; y < place.size * kWorstScale; ++y)
    for (int x = 0; x < place.size * kWorstScale; ++x) {
      const uint8_t* pixel = from.at(place.x + x / kWorstScale, place.y + y / kWorstScale);
      uint8_t* into = to.at(left + x, y);
      for (int c = 0; c < 3; ++c) into[c] = pixel[from.channels >= 3 ? c : 0];
    }
}

// The exact shadow and the labels beside it.
std::string worstPicture(const Image8& exact, const Image8& labels, const WorstPlace& place) {
  const int side = place.size * kWorstScale;
  Image8 image(2 * side + kWorstScale, side, 3, 255);
  paste(exact, place, image, 0);
  paste(labels, place, image, side + kWorstScale);
  return encodePng(image);
}

std::string mediaCommand(const SetupOptions& setup, const SweepMedium& medium, const MediaMethod& method) {
  std::string line = "gnomon fog";
  for (const std::string& word : setupWords(setup)) line += " " + shellWord(word);
  const PlanMedium& spec = medium.spec;
  line += fmt::format(" --truth --bound {:g} --integrators {}", spec.bound, method.integrator->name);
  if (method.steps > 0) line += fmt::format(" --steps {}", method.steps);
  if (spec.sigmaS > 0.0) line += fmt::format(" --sigma-s {:g}", spec.sigmaS);
  if (spec.sigmaA > 0.0) line += fmt::format(" --sigma-a {:g}", spec.sigmaA);
  return line + fmt::format(" --g {:g} --march-map {} --map-size {}", spec.g, spec.map, spec.mapSize);
}

}  // namespace

StageClock::Running::~Running() {
  clock_.seconds_[stage_] += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}

Stages StageClock::stages() const {
  Stages stages(seconds_.begin(), seconds_.end());
  std::ranges::sort(stages, std::greater(), [](const auto& stage) { return stage.second; });
  return stages;
}

struct SweepMeasurer::State {
  const Plan& plan;
  const Axes& axes;
  const Survey& survey;
  std::shared_ptr<const gpu::Device> device;
  StageClock& clock;

  std::optional<SweepView> at;
  std::shared_ptr<const TracedScene> traced;
  std::unique_ptr<const SceneView> picture;
  std::unique_ptr<ShadowPasses> passes;  // of all scenes: pictures have one size
  double gbufferMs = 0.0;

  const SurveyedScene& scene() const { return survey.scenes[at->scene]; }
  const Chosen<Light>& light() const { return scene().lights[at->light]; }
  const Chosen<Camera>& camera() const { return scene().cameras[at->camera]; }

  SetupOptions setup() const {
    SetupOptions setup = axes.scenes[scene().at].setup;
    setup.light = light().text;
    setup.camera = camera().text;
    return setup;
  }

  void enter(const SweepView& view) {
    const bool newScene = !at || at->scene != view.scene;
    const bool newCamera = newScene || at->camera != view.camera;
    at = view;
    if (newScene) {
      const auto running = clock.run("scene");
      picture.reset();
      traced = tracedScene(axes, scene());
    }
    if (newCamera) {
      const auto running = clock.run("G-buffer");
      const PictureSize size = parseSize(plan.size, camera().thing.aspect);
      picture = picture ? std::make_unique<const SceneView>(*picture, camera().thing)
                        : std::make_unique<const SceneView>(device, traced, camera().thing, size.width, size.height);
      if (!passes) passes = std::make_unique<ShadowPasses>(*picture);
      std::vector<double> times;
      for (int i = 0; i < plan.repeats; ++i) times.push_back(picture->timeGBuffer());
      gbufferMs = median(times);
    }
  }
};

SweepMeasurer::SweepMeasurer(const Plan& plan, const Axes& axes, const Survey& survey,
                             std::shared_ptr<const gpu::Device> device, StageClock& clock)
    : state_(new State{.plan = plan, .axes = axes, .survey = survey, .device = std::move(device), .clock = clock}) {}

SweepMeasurer::~SweepMeasurer() = default;

void SweepMeasurer::enter(const SweepView& view) {
  try {
    state_->enter(view);
  } catch (...) {
    state_->at.reset();  // what is there is of no view
    throw;
  }
}

namespace {

// The rows of one case, one after another.
class CaseRows {
 public:
  CaseRows(LightOnMap& lit, const Axes& axes, const WantedCase& wanted, const SetupOptions& setup, StageClock& clock)
      : lit_(lit), axes_(axes), wanted_(wanted), map_(axes.maps[wanted.map]), setup_(setup), clock_(clock) {
    expectMethods();
  }

  // Those of one method come one after another.
  StoredRow measure(const WantedRow& wanted) {
    const SweepMethod& method = axes_.methods[wanted.method];
    const Filter& filter = *axes_.filters[wanted.filter];
    const ChosenFilter chosen = filterFor(method.knobs, filter);
    if (method.tune || judgedMethod_ != &method) judge(method, chosen);
    const CompareOptions options = optionsOf(method, filter);
    StoredRow stored{.key = wanted.key, .slot = wanted.slot, .method = method.label};
    Row& row = stored.row = measuredRow(lit_, method_, judged_, filter, options);
    row.tuning = tuning_;
    row.rmse = rmseOf(chosen);
    row.command = rowCommand(setup_, options, row);
    return stored;
  }

  void addPicture(StoredRow& stored) {
    const Row& row = stored.row;
    const bool isAcne = row.worstAcne && (!row.worstLeak || *row.worstAcne->pixels >= *row.worstLeak->pixels);
    const std::optional<WorstPlace>& place = isAcne ? row.worstAcne : row.worstLeak;
    if (!place) return;
    const auto running = clock_.run("pictures");
    if (exact_.values.empty())
      exact_ = visibilityPicture(lit_.receivers(), truthVisibility(lit_.receivers(), lit_.truth()));
    const Image8 labels = labelPicture(lit_.receivers(), lit_.truth(), judged_.labels, "");
    stored.pictures.push_back({isAcne ? "acne" : "leak", worstPicture(exact_, labels, *place)});
  }

 private:
  // What lit_ can decide together.
  void expectMethods() {
    std::vector<Method> methods;
    for (const WantedRow& row : wanted_.rows)
      if (const SweepMethod& method = axes_.methods[row.method]; !method.tune)
        methods.push_back(methodFor(lit_.view(), method.knobs, *method.bias));
    lit_.expect(std::move(methods));
  }

  CompareOptions optionsOf(const SweepMethod& method, const Filter& filter) const {
    CompareOptions options;
    static_cast<MapChoice&>(options) = map_.choice;
    static_cast<KnobChoices&>(options) = method.knobs;
    options.maps = {map_.map};
    options.biases = {method.bias};
    options.filters = {&filter};
    if (method.user) options.userBiases = {method.user};
    return options;
  }

  void judge(const SweepMethod& method, const ChosenFilter& filter) {
    method_ = methodFor(lit_.view(), method.knobs, *method.bias);
    tuning_.reset();
    if (method.tune) {
      const auto running = clock_.run("tuning");
      auto& evaluator = evaluators_[filter.id];
      if (!evaluator) evaluator = std::make_unique<TuningEvaluator>(lit_, filter);
      const TunedMethod tuned = tune(*evaluator, method_);
      method_ = tuned.method;
      tuning_ = tuningOf(tuned);
      expectMethods();  // the search had its own
    }
    const auto running = clock_.run("judging");
    judged_ = lit_.judge(method_);
    judgedMethod_ = &method;
  }

  double rmseOf(const ChosenFilter& filter) {
    const bool isPlain = filter.id == glsl::kShadowFilterNone;
    const auto running = clock_.run(isPlain ? "judging" : "filters");
    std::vector<float>& truth = filteredTruths_[filter.id];
    if (truth.empty()) truth = lit_.filteredTruth(filter);
    std::vector<float> visibility = isPlain ? judged_.visibility : lit_.visibility(method_, filter);
    for (const size_t pixel : judged_.edgeOn) visibility[pixel] = truth[pixel];
    return scoredRmse(lit_.receivers(), visibility, truth);
  }

  LightOnMap& lit_;
  const Axes& axes_;
  const WantedCase& wanted_;
  const SweepMap& map_;
  const SetupOptions setup_;
  StageClock& clock_;
  const SweepMethod* judgedMethod_ = nullptr;
  Method method_;
  LabelledResult judged_;
  std::optional<Tuning> tuning_;
  std::map<int, std::unique_ptr<TuningEvaluator>> evaluators_;  // by filter
  std::map<int, std::vector<float>> filteredTruths_;
  Image8 exact_;
};

// Rounds run one after another through all methods. What differs in its parameters alone takes the same time.
void timeRows(LightOnMap& lit, const Plan& plan, const Axes& axes, const std::vector<WantedRow>& wanted,
              double gbufferMs, std::vector<StoredRow>& rows) {
  struct Timed {
    std::string name;
    Method method;
    ChosenFilter filter;
    std::vector<double> ms;
  };
  std::vector<Timed> shades;
  std::map<ChannelSet, std::vector<double>> builds;
  std::vector<size_t> timedBy;
  for (const WantedRow& row : wanted) {
    const SweepMethod& method = axes.methods[row.method];
    const Filter& filter = *axes.filters[row.filter];
    std::string name = fmt::format("{} {}", method.bias->name, filter.name);
    for (const BiasChoice* choice : method.bias->choices)
      name += fmt::format(" {}", method.knobs.choices.*choice->member);
    auto found = std::ranges::find(shades, name, &Timed::name);
    if (found == shades.end()) {
      shades.push_back({name, methodFor(lit.view(), method.knobs, *method.bias), filterFor(method.knobs, filter), {}});
      found = shades.end() - 1;
    }
    timedBy.push_back(static_cast<size_t>(found - shades.begin()));
    builds[method.bias->channels];
  }
  for (const Timed& shade : shades) lit.warmUp(shade.method, shade.filter);
  for (int round = 0; round < plan.repeats; ++round) {
    throwIfInterrupted();
    for (auto& [channels, times] : builds) times.push_back(lit.redraw(channels));
    for (Timed& shade : shades) shade.ms.push_back(lit.timeVisibility(shade.method, shade.filter));
  }
  for (size_t i = 0; i < rows.size(); ++i)
    rows[i].times = StoredTimes{.gbufferMs = gbufferMs,
                                .buildMs = median(builds.at(axes.methods[wanted[i].method].bias->channels)),
                                .shadeMs = median(shades[timedBy[i]].ms),
                                .rounds = plan.repeats};
}

StoredCase describedBy(StoredCase stored, const LightOnMap& lit) {
  stored.lit = lit.truth().litCount;
  stored.marginFlipsHalf = lit.truth().marginFlipsHalf;
  stored.marginFlipsDouble = lit.truth().marginFlipsDouble;
  stored.texel = medianTexelWidth(lit);
  return stored;
}

}  // namespace

std::optional<SweepMeasurer::Measured> SweepMeasurer::measure(
    const WantedCase& wanted, const std::function<double(const std::string&)>& leastOfWorst) {
  const SweepMap& map = state_->axes.maps[wanted.map];
  std::optional<LightOnMap> mapped;
  {
    const auto running = state_->clock.run("ground truth");
    mapped.emplace(*state_->picture, *state_->passes, *map.map, state_->light().thing,
                   mapSetupOf(map.choice, *map.map));
    if (mapped->receivers().scored == 0) return std::nullopt;
  }
  LightOnMap& lit = *mapped;
  {
    const auto running = state_->clock.run("map");
    lit.fitted();
    for (const WantedRow& row : wanted.rows) lit.occluders(state_->axes.methods[row.method].bias->channels);
  }
  CaseRows caseRows(lit, state_->axes, wanted, state_->setup(), state_->clock);
  Measured measured;
  for (const WantedRow& row : wanted.rows) {
    throwIfInterrupted();
    StoredRow& stored = measured.rows.emplace_back(caseRows.measure(row));
    if (leastOfWorst && stored.row.biasError() > 0.0 && stored.row.biasError() >= leastOfWorst(stored.method))
      caseRows.addPicture(stored);
  }
  if (state_->plan.repeats > 0) {
    const auto running = state_->clock.run("timing");
    timeRows(lit, state_->plan, state_->axes, wanted.rows, state_->gbufferMs, measured.rows);
  }
  measured.of = describedBy(wanted.stored, lit);
  return measured;
}

std::vector<StoredMedium> SweepMeasurer::measureMedia(const WantedMedia& wanted) {
  const SweepMedium& medium = state_->axes.media[wanted.medium];
  const auto running = state_->clock.run("media");
  const SceneView& picture = *state_->picture;
  FogMedium fog;
  if (medium.spec.sigmaS > 0.0) fog.sigmaS = glm::vec3(static_cast<float>(medium.spec.sigmaS));
  fog.sigmaA = glm::vec3(static_cast<float>(medium.spec.sigmaA));
  fog.g = static_cast<float>(medium.spec.g);
  const FogView view = lookIntoFog(picture, *state_->passes, {state_->light().thing}, fog);
  FogMethodOptions how{.marchMap = medium.map,
                       .mapSide = medium.spec.mapSize,
                       .cull = parseCullMode(state_->plan.cull),
                       .repeats = state_->plan.repeats};
  for (const WantedMedium& row : wanted.rows) how.methods.push_back(medium.methods[row.method]);
  const std::vector<FogMethodResult> results = runFogMethods(picture, *state_->passes, view, how);
  const MediaReference reference = referenceFor(picture, view, {.bound = medium.spec.bound}, true).reference;
  std::vector<StoredMedium> rows;
  for (size_t i = 0; i < results.size(); ++i) {
    const MediaMethod& method = how.methods[i];
    StoredMedium row{.key = wanted.rows[i].key, .slot = wanted.rows[i].slot, .integrator = method.integrator->name};
    if (method.steps > 0) row.steps = method.steps;
    row.map = medium.spec.map;
    row.medium = medium.label;
    row.relRmse = relativeRmse(results[i].inScattered, reference.inScattered);
    row.relRmse99 = relativeRmse(results[i].inScattered, reference.inScattered, 0.99);
    row.command = mediaCommand(state_->setup(), medium, method);
    if (state_->plan.repeats > 0)
      row.times = StoredTimes{.gbufferMs = state_->gbufferMs,
                              .buildMs = results[i].buildMs(),
                              .shadeMs = results[i].integrateMs,
                              .rounds = state_->plan.repeats};
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace gnomon
