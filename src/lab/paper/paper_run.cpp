#include "lab/paper/paper_run.h"

#include "base/check.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "lab/compare/compare_command.h"
#include "lab/compare/results.h"
#include "lab/picture/pictures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kLeastSide = 16;  // pixels or texels, of what is scaled down

std::string countsText(const Row& row) {
  std::string text = fmt::format("acne {}, leak {}, edges {} of {} scored pixels", row.acne, row.leak,
                                 row.edgeShadow + row.edgeLight, row.scored);
  if (row.flip) text += fmt::format("; FLIP {:.4f}", *row.flip);
  return text;
}

std::string pathOf(const Pictures& pictures, const std::string& kind, const std::string& below) {
  for (const auto& [name, path] : pictures)
    if (name == kind) return below + "/" + path;
  return "";
}

}  // namespace

PaperRun::PaperRun(const gpu::DeviceOptions& device, const ReproduceOptions& options, int partCount)
    : device_(device), options_(options), partCount_(partCount) {
  result_.paper = options.paper;
}

void PaperRun::part(const std::string& name, const std::function<void()>& work) {
  title_ = fmt::format("{} {}/{}, {}:", options_.paper, ++parts_, partCount_, name);
  if (!ownScene()) {
    work();
    return;
  }
  const size_t figures = result_.figures.size();
  try {
    work();
  } catch (const WorldError& error) {
    result_.figures.resize(figures);
    leaveOut(name, error.what());
  }
}

void PaperRun::leaveOut(const std::string& what, const std::string& why) {
  result_.leftOut.push_back({what, why});
}

const Session& PaperRun::open(const std::string& scene, const std::string& light, const std::string& camera,
                              int pixels) {
  SetupOptions setup{.scene = scene, .light = light, .camera = camera, .size = std::to_string(pixels)};
  if (ownScene()) setup = {.scene = options_.scene, .size = setup.size};
  return open(setup);
}

const Session& PaperRun::openCamera(const std::string& camera) {
  SetupOptions setup = session_->setup();
  setup.camera = camera;
  return open(setup);
}

const Session& PaperRun::open(const SetupOptions& setup) {
  const std::string key = setup.scene + "\n" + setup.light + "\n" + setup.camera + "\n" + setup.size;
  if (key == opened_) return *session_;
  throwIfInterrupted();
  Progress(title_, 1).step("opening " + setup.scene);
  opened_.clear();
  session_.reset();  // before the next one takes memory
  session_ = std::make_unique<Session>(device_, setup);
  opened_ = key;
  result_.device = session_->device().info().name;
  return *session_;
}

int PaperRun::scaled(int side) const {
  return std::max(kLeastSide, static_cast<int>(std::lround(side * options_.scale)));
}

VolumeSize PaperRun::scaled(const VolumeSize& size) const {
  // phi comes in texels of 128 bits
  const int phi = 128 * std::max(1, static_cast<int>(std::lround(size.phi * options_.scale / 128.0)));
  return {.alpha = scaled(size.alpha), .theta = scaled(size.theta), .phi = phi};
}

void PaperRun::number(const std::string& quantity, const std::string& place, double value) {
  const bool isNew = result_.numbers.emplace(fmt::format("{}({})", quantity, place), value).second;
  GNOMON_CHECK(isNew);
}

Figure& PaperRun::addFigure(Figure figure) {
  result_.figures.push_back(std::move(figure));
  return result_.figures.back();
}

void PaperRun::judge(const std::vector<Claim>& claims) {
  for (const Claim& claim : claims) result_.claims.push_back(judgeClaim(claim, result_.numbers));
}

FigureRun::FigureRun(PaperRun& run, const std::string& id, const std::string& title)
    : run_(run), id_(id), index_(run.result().figures.size()) {
  run.addFigure({.id = id, .title = title, .setup = {}, .panels = {}, .svg = {}});
}

Comparison FigureRun::compare(const std::string& name, const CompareOptions& asked) {
  const Session& session = run_.session();
  CompareOptions options = asked;
  options.repeats = 1;  // what is timed is timed in rounds, elsewhere
  options.tuneElsewhere = false;
  options.progressTitle = run_.progressTitle();
  below_ = folder() + "/" + name;
  if (!run_.options().outDir.empty()) options.outDir = run_.options().outDir / below_;
  Comparison comparison = gnomon::compare(session, options);
  throwIfInterrupted();  // rows that are missing decide no claim
  run_.addComparison(below_, resultsJson(session, comparison, compareCommand(session.setup(), options)));
  const TruthSummary& truth = comparison.truths.front();
  const Row& row = comparison.rows.front();
  std::string text = fmt::format("{}, light '{}', camera '{}', {} × {} pixels; {} map, {} {}", session.scene().name,
                                 truth.light.name, session.camera().name, session.view().width, session.view().height,
                                 row.map, row.mapDimensions, row.map == "vsv" ? "voxels" : "texels a side");
  if (figure().setup.find(text) == std::string::npos) figure().setup += (figure().setup.empty() ? "" : "; ") + text;
  return comparison;
}

void FigureRun::panel(const std::string& name, const Row& row, const std::string& what, const std::string& says,
                      const char* picture) {
  figure().panels.push_back({.name = name,
                             .what = what,
                             .says = says,
                             .counts = countsText(row),
                             .command = row.command,
                             .picture = pathOf(row.pictures, picture, below_),
                             .labels = pathOf(row.pictures, "labels", below_)});
  number("scored", name, static_cast<double>(row.scored));
  number("acne", name, static_cast<double>(row.acne));
  number("leak", name, static_cast<double>(row.leak));
  number("edge", name, static_cast<double>(row.edgeShadow + row.edgeLight));
  number("wrong", name, static_cast<double>(row.scored - row.agree));
  number("error", name, row.biasError());
  number("rmse", name, row.rmse);
  if (row.flip) number("flip", name, *row.flip);
}

void FigureRun::exactPanel(const std::string& name, const Comparison& comparison, const std::string& what,
                           const std::string& says) {
  const MapSummary& map = comparison.maps.front();
  figure().panels.push_back({.name = name,
                             .what = what,
                             .says = says,
                             .counts = {},
                             .command = {},
                             .picture = pathOf(map.pictures, "truth_beauty", below_),
                             .labels = pathOf(map.pictures, "truth", below_)});
}

void FigureRun::unshadowedPanel(const std::string& name, const Parameterization& map, const std::string& what,
                                const std::string& says) {
  Panel panel{.name = name, .what = what, .says = says, .counts = {}, .command = {}, .picture = {}, .labels = {}};
  if (!run_.options().outDir.empty()) {
    const Session& session = run_.session();
    ShadowPasses passes(session);
    const LightOnMap lit = openLight(session, passes, map, {});
    const std::vector<float> everything(lit.truth().lit.size(), 1.0f);
    panel.picture = folder() + "/" + name + ".unshadowed.png";
    writePng(run_.options().outDir / panel.picture, toSrgb8(lit.radiance(everything)));
  }
  figure().panels.push_back(panel);
}

const Row& rowOf(const Comparison& comparison, const std::string& bias, const std::string& filter, bool tuned) {
  const auto found = std::ranges::find_if(comparison.rows, [&](const Row& row) {
    return row.bias == bias && row.filter == filter && row.tuning.has_value() == tuned;
  });
  GNOMON_CHECK(found != comparison.rows.end());
  return *found;
}

KnobValue knobOfScale(const Session& session, const char* bias, float share) {
  return {&findBias(bias).knobs.front(), share * computeBounds(session.scene()).diagonal()};
}

std::vector<FrameCost> timeFrames(const Session& session, const Parameterization& map,
                                  const std::vector<FrameKind>& kinds, int repeats, const std::string& progressTitle) {
  ShadowPasses passes(session);
  const LightOnMap light = openLight(session, passes, map, {});
  std::map<int, LightOnMap> maps;  // by side
  for (const FrameKind& kind : kinds)
    if (kind.bias != nullptr) maps.try_emplace(kind.mapSide, light, MapSetup{.side = kind.mapSide});
  Progress progress(progressTitle, repeats + 1);
  std::vector<std::vector<double>> mapMs(kinds.size());
  std::vector<std::vector<double>> visibilityMs = mapMs, shadeMs = mapMs, frameMs = mapMs, ratios = mapMs;
  for (int round = -1; round < repeats; ++round) {  // round -1 compiles the pipelines
    throwIfInterrupted();
    progress.step(round < 0 ? "first frames" : fmt::format("round {} of {} of frames", round + 1, repeats));
    double first = 0.0;
    std::map<std::pair<int, ChannelSet>, double> drawn;  // methods that share a map share what it took
    for (size_t i = 0; i < kinds.size(); ++i) {
      const FrameKind& kind = kinds[i];
      double build = 0.0, visibility = 0.0, rest = session.timeGBuffer();
      if (kind.bias != nullptr) {
        LightOnMap& lit = maps.at(kind.mapSide);
        const std::pair key(kind.mapSide, kind.bias->channels);
        if (!drawn.contains(key)) drawn[key] = lit.redraw(kind.bias->channels);
        build = drawn[key];
        visibility = lit.timeVisibility(atDefaults(*kind.bias, session), kind.filter->id);
      }
      rest += passes.timeShading(session);
      const double frame = build + visibility + rest;
      if (i == 0) first = frame;
      if (round < 0) continue;
      mapMs[i].push_back(build);
      visibilityMs[i].push_back(visibility);
      shadeMs[i].push_back(visibility + rest);
      frameMs[i].push_back(frame);
      ratios[i].push_back(frame / first);
    }
  }
  std::vector<FrameCost> costs;
  for (size_t i = 0; i < kinds.size(); ++i)
    costs.push_back({.mapMs = median(mapMs[i]),
                     .visibilityMs = median(visibilityMs[i]),
                     .shadeMs = median(shadeMs[i]),
                     .frameMs = median(frameMs[i]),
                     .ratio = median(ratios[i])});
  return costs;
}

}  // namespace gnomon
