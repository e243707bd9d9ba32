// Weiskopf, Ertl, "Shadow Mapping Based on Dual Depth Layers", Eurographics 2003 short papers: figures 5 to
// 7, table 1, and what section 7 says of the offset.
#include "lab/compare/tune.h"
#include "lab/core/maps.h"
#include "lab/paper/paper_run.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr const char* kPaper = "weiskopf2003";

const Parameterization& directional() {
  return *parseMaps("directional").front();
}

CompareOptions directionalMap(const PaperRun& run, int side, const char* biases) {
  CompareOptions options;
  options.maps = {&directional()};
  options.mapSide = run.scaled(side);
  options.biases = parseBiases(biases);
  return options;
}

// Figure 5. The map has a texel of 0.12 m on the scene of 12 m, and the offset of half a hundredth of the
// scene's diagonal (0.09 m) is that texel times the slope of the light: enough for every lit plane. The large
// constant is as high as the block.
constexpr int kFigure5Map = 96;  // texels
constexpr float kSmallOffset = 0.005f, kLargeOffset = 0.12f;

void figure5(PaperRun& run) {
  const Session& session = run.open("lshape", "", "", run.scaled(512));
  FigureRun figure(run, "5", "A solid block above a ground, on a heavily undersampled map");
  CompareOptions options = directionalMap(run, kFigure5Map, "midpoint,dual");
  options.cull = CullMode::None;
  options.knobs = {knobOfScale(session, "dual", kSmallOffset)};
  const Comparison open = figure.compare("nothing-culled", options);
  figure.exactPanel("a", open, "the exact shadow", "A high-quality rendering, to hold the others against.");
  figure.panel("b", rowOf(open, "midpoint"), "midpoint, nothing culled",
               "Light where there should be shadow at the crease, and shadow on lit silhouettes.");
  figure.panel("c", rowOf(open, "dual"), "dual, nothing culled",
               "No light at the crease, but the same shadow on lit silhouettes.");
  options = directionalMap(run, kFigure5Map, "constant,midpoint,dual");
  options.knobs = {knobOfScale(session, "dual", kSmallOffset), knobOfScale(session, "constant", kLargeOffset)};
  const Comparison solids = figure.compare("solids-culled", options);
  figure.panel("d", rowOf(solids, "constant"), "a large constant",
               "Surfaces in shadow become lit, as beside the crease.");
  figure.panel("e", rowOf(solids, "midpoint"), "midpoint, solids culled",
               "The shadow on lit silhouettes is gone; more light where there should be shadow.");
  figure.panel("f", rowOf(solids, "dual"), "dual, solids culled",
               "Convincing, although the map is heavily undersampled.");
}

// Figures 6 and 7: the paper does not tell its offsets, which were set by hand. Here each is the best for the picture.
void figure6(PaperRun& run) {
  run.open("double-torus", "", "", run.scaled(768));
  FigureRun figure(run, "6", "Curved solids, with bilinear filtering and without");
  CompareOptions options = directionalMap(run, 128, "constant,midpoint,dual");
  options.filters = parseFilters("none,bilinear");
  options.tune = true;
  const Comparison all = figure.compare("solids-culled", options);
  const std::array<const char*, 2> filters = {"none", "bilinear"};
  const std::array<std::array<const char*, 3>, 2> names = {{{"a", "b", "c"}, {"d", "e", "f"}}};
  for (size_t i = 0; i < filters.size(); ++i) {
    const std::string through = i == 0 ? "" : ", bilinear";
    figure.panel(names[i][0], rowOf(all, "constant", filters[i], true), "the best constant" + through,
                 i == 0 ? "The original technique." : "Softer edges; artefacts show less.");
    figure.panel(names[i][1], rowOf(all, "midpoint", filters[i]), "midpoint" + through,
                 i == 0 ? "Light where there should be shadow on the torus."
                        : "Softer edges, but the light on the torus remains clearly noticeable.");
    figure.panel(names[i][2], rowOf(all, "dual", filters[i], true), "dual with its best offset" + through,
                 i == 0 ? "No such light." : "No such light, and softer edges.");
  }
}

void figure7(PaperRun& run) {
  run.open("factory", "", "", run.scaled(1024));
  FigureRun figure(run, "7", "A more realistic scene, through a 4 × 4 jittered filter");
  figure.unshadowedPanel("a", directional(), "no shadow", "No shadow.");
  CompareOptions options = directionalMap(run, 1024, "constant,midpoint,dual");
  options.filters = parseFilters("jitter4x4");
  options.tune = true;
  const Comparison all = figure.compare("solids-culled", options);
  figure.panel("b", rowOf(all, "constant", "jitter4x4", true), "the best constant", "A constant bias.");
  figure.panel("c", rowOf(all, "midpoint", "jitter4x4"), "midpoint",
               "Although the map's resolution is acceptable, still light where there should be shadow.");
  figure.panel("d", rowOf(all, "dual", "jitter4x4", true), "dual with its best offset", "Such light is avoided.");
}

// Table 1: frames a second of 2003's hardware, so ratios are what can be compared.
struct PublishedFrames {
  int mapSide;
  const char* filter;
  double constantFps, dualFps;
};
constexpr double kNoShadowFps = 167.5;
constexpr std::array<PublishedFrames, 6> kPublishedFrames = {{{256, "none", 106.2, 85.3},
                                                              {2048, "none", 69.1, 30.6},
                                                              {256, "bilinear", 44.8, 40.6},
                                                              {2048, "bilinear", 36.6, 21.9},
                                                              {256, "jitter4x4", 27.2, 25.5},
                                                              {2048, "jitter4x4", 23.9, 16.6}}};

// What a method is answerable for.
std::string shadowText(const FrameCost& cost) {
  return fmt::format("{:.1f}", cost.mapMs + cost.visibilityMs);
}

void frameTable(PaperRun& run) {
  const Session& session = run.open("factory", "", "", run.scaled(1100));
  std::vector<FrameKind> kinds = {{.name = "no shadow"}};
  const std::array<const char*, 3> biases = {"constant", "midpoint", "dual"};
  for (const PublishedFrames& line : kPublishedFrames)
    for (const char* bias : biases)
      kinds.push_back({.name = fmt::format("{} {} {}", bias, line.mapSide, line.filter),
                       .bias = &findBias(bias),
                       .filter = parseFilters(line.filter).front(),
                       .mapSide = run.scaled(line.mapSide)});
  const std::vector<FrameCost> costs =
      timeFrames(session, directional(), kinds, run.options().repeats, run.progressTitle());
  for (size_t i = 0; i < kinds.size(); ++i) {
    run.number("frame_ms", kinds[i].name, costs[i].frameMs);
    run.number("ratio", kinds[i].name, costs[i].ratio);
  }
  PaperTable table{
      .id = "1",
      .title = "A frame's time, as a ratio to the frame without shadow",
      .note = fmt::format(
          "Here: {}, {} × {} pixels; a frame is G-buffer, map, visibility and shading; without shadow {:.2f} "
          "ms. The paper: {} frames a second without shadow, on an ATI Radeon 9700.",
          session.scene().name, session.view().width, session.view().height, costs[0].frameMs, kNoShadowFps),
      .columns = {"map, filter", "constant: paper", "here", "here, ms", "midpoint and dual: paper", "midpoint here",
                  "dual here", "dual here, ms", "map and visibility, ms: constant", "midpoint", "dual"},
      .rows = {}};
  for (size_t i = 0; i < kPublishedFrames.size(); ++i) {
    const PublishedFrames& line = kPublishedFrames[i];
    const FrameCost *constant = &costs[1 + 3 * i], *midpoint = constant + 1, *dual = constant + 2;
    table.rows.push_back({fmt::format("{}, {}", run.scaled(line.mapSide), line.filter),
                          fmt::format("{:.2f}", kNoShadowFps / line.constantFps),
                          fmt::format("{:.2f}", constant->ratio), fmt::format("{:.1f}", constant->frameMs),
                          fmt::format("{:.2f}", kNoShadowFps / line.dualFps), fmt::format("{:.2f}", midpoint->ratio),
                          fmt::format("{:.2f}", dual->ratio), fmt::format("{:.1f}", dual->frameMs),
                          shadowText(*constant), shadowText(*midpoint), shadowText(*dual)});
  }
  run.addTable(std::move(table));
}

// Section 7: how the error depends on the offset.
void offsets(PaperRun& run) {
  const Session& session = run.open("factory", "", "", run.scaled(512));
  ShadowPasses passes(session);
  LightOnMap lit = openLight(session, passes, directional(), {.side = run.scaled(1024)});
  TuningEvaluator evaluator(lit);
  const float diagonal = evaluator.sceneScale();
  const auto errorOf = [&](const char* bias, float share) {
    CompareOptions options;
    if (share > 0.0f) options.knobs = {knobOfScale(session, bias, share)};
    return static_cast<double>(evaluator.biasErrors(methodFor(session, options, findBias(bias)))) / evaluator.scored();
  };
  PaperTable table{.id = "of offsets",
                   .title = "Section 7: bias error against the offset",
                   .note = fmt::format("{}, {} × {} pixels, directional map of {} texels a side.", session.scene().name,
                                       session.view().width, session.view().height, run.scaled(1024)),
                   .columns = {"offset, m", "constant", "dual"},
                   .rows = {}};
  std::array<double, 2> least = {1.0, 1.0}, most = {0.0, 0.0};
  const std::array<const char*, 2> biases = {"constant", "dual"};
  for (float share = 0.001f; share < 0.1f; share *= 2.0f) {
    table.rows.push_back({fmt::format("{:.3f}", share * diagonal)});
    for (size_t i = 0; i < biases.size(); ++i) {
      const double error = errorOf(biases[i], share);
      least[i] = std::min(least[i], error);
      most[i] = std::max(most[i], error);
      table.rows.back().push_back(fmt::format("{:.4f} %", 100.0 * error));
    }
  }
  for (size_t i = 0; i < biases.size(); ++i) {
    run.number("least", fmt::format("{} offsets", biases[i]), least[i]);
    run.number("most", fmt::format("{} offsets", biases[i]), most[i]);
  }
  run.number("error", "dual, endless offset", errorOf("dual", 1000.0f));
  run.number("error", "midpoint", errorOf("midpoint", 0.0f));
  run.addTable(std::move(table));
}

}  // namespace

// "Shows" an artefact: 0.02% of the scored pixels or more, which are 200 of a picture of 1024 x 1024. "None":
// less than a tenth of that. "Avoids", "removes": to less than a tenth; half is a part of it. "The same": to
// within a tenth.
std::vector<Claim> weiskopfClaims() {
  return {
      {kPaper,
       "5 (b)",
       "Midpoint maps without culling show shadow on silhouettes and light at the crease.",
       "midpoint, nothing culled",
       {"acne(5b) >= 0.02% scored(5b)", "leak(5b) >= 0.02% scored(5b)"}},
      {kPaper,
       "5 (c)",
       "Dual maps without culling avoid that light.",
       "dual, nothing culled",
       {"leak(5c) <= leak(5b) / 2", "leak(5c) <= leak(5b) / 10"}},
      {kPaper,
       "5 (c)",
       "They keep the same shadow on silhouettes.",
       "dual, nothing culled",
       {"0.9 acne(5b) <= acne(5c) <= 1.1 acne(5b)"}},
      {kPaper,
       "5 (d)",
       "With too large a constant, surfaces in shadow become lit.",
       "a large constant",
       {"leak(5d) >= 0.02% scored(5d)", "leak(5d) > 10 leak(5f)"}},
      {kPaper,
       "5 (e)",
       "Culling solids removes the midpoint maps' shadow on silhouettes.",
       "midpoint, solids culled",
       {"acne(5e) <= acne(5b) / 2", "acne(5e) <= acne(5b) / 10"}},
      {kPaper,
       "5 (e)",
       "It brings additional light near silhouettes.",
       "midpoint, solids culled",
       {"leak(5e) > leak(5b)"}},
      {kPaper,
       "5 (f)",
       "Dual maps with solids culled are convincing on heavily undersampled maps.",
       "dual, solids culled",
       {"acne(5f) < 0.002% scored(5f)", "leak(5f) < 0.002% scored(5f)"}},
      {kPaper,
       "6 (b)",
       "Midpoint maps light parts of the torus that lie in shadow.",
       "midpoint",
       {"leak(6b) >= 0.02% scored(6b)"}},
      {kPaper,
       "6 (c)",
       "Dual maps avoid that.",
       "dual with its best offset",
       {"leak(6c) <= leak(6b) / 2", "leak(6c) <= leak(6b) / 10"}},
      {kPaper,
       "6 (d-f)",
       "Bilinear filtering makes the artefacts less visible.",
       "each unfiltered and filtered, compared with the exact shadow through the same filter",
       {"rmse(6d) < rmse(6a)", "rmse(6e) < rmse(6b)", "rmse(6f) < rmse(6c)", "flip(6d) < flip(6a)",
        "flip(6e) < flip(6b)", "flip(6f) < flip(6c)"}},
      {kPaper,
       "6 (e)",
       "Through the filter the midpoint maps' artefacts remain, beyond those of dual maps.",
       "midpoint and dual, bilinear",
       {"rmse(6e) > rmse(6f)", "flip(6e) > flip(6f)"}},
      {kPaper,
       "7 (c)",
       "On a map of acceptable resolution midpoint maps still light what lies in shadow.",
       "midpoint, 4 × 4 filter",
       {"leak(7c) >= 0.02% scored(7c)"}},
      {kPaper,
       "7 (d)",
       "Dual maps avoid these artefacts.",
       "dual with its best offset, 4 × 4 filter",
       {"leak(7d) <= leak(7c) / 2", "leak(7d) <= leak(7c) / 10"}},
      {kPaper,
       "table 1",
       "Midpoint and dual maps run at the same speed.",
       "frames, interleaved",
       {"0.9 ratio(midpoint 256 none) <= ratio(dual 256 none) <= 1.1 ratio(midpoint 256 none)",
        "0.9 ratio(midpoint 2048 none) <= ratio(dual 2048 none) <= 1.1 ratio(midpoint 2048 none)"}},
      {kPaper,
       "table 1",
       "On large maps they have roughly half the speed of a constant bias.",
       "frames, interleaved; roughly half means one to two thirds",
       {"1.5 ratio(constant 2048 none) <= ratio(dual 2048 none) <= 3 ratio(constant 2048 none)"}},
      {kPaper,
       "table 1",
       "On small maps, or with more filtering, the difference is much smaller.",
       "frames, interleaved; much smaller means less than half",
       {"ratio(dual 256 none) / ratio(constant 256 none) - 1 < (ratio(dual 2048 none) / ratio(constant 2048 "
        "none) - 1) / 2",
        "ratio(dual 2048 jitter4x4) / ratio(constant 2048 jitter4x4) - 1 < (ratio(dual 2048 none) / "
        "ratio(constant 2048 none) - 1) / 2"}},
      {kPaper,
       "section 7",
       "With an infinite offset dual maps become midpoint maps.",
       "a sweep of the offset",
       {"error(midpoint) <= error(dual, endless offset) <= error(midpoint)"}},
      {kPaper,
       "section 7",
       "The result depends much less on the offset than a constant's does.",
       "a sweep of the offset over a factor of 64; much less means less than a quarter of the spread",
       {"most(dual offsets) - least(dual offsets) < (most(constant offsets) - least(constant offsets)) / 4"}},
  };
}

Reproduction reproduceWeiskopf2003(const gpu::DeviceOptions& device, const ReproduceOptions& options) {
  PaperRun run(device, options, 5);
  run.result().citation = "D. Weiskopf and T. Ertl, “Shadow Mapping Based on Dual Depth Layers”, Eurographics 2003";
  run.part("figure 5", [&] { figure5(run); });
  run.part("figure 6", [&] { figure6(run); });
  run.part("figure 7", [&] { figure7(run); });
  run.part("table 1", [&] { frameTable(run); });
  run.part("section 7", [&] { offsets(run); });
  run.judge(weiskopfClaims());
  return std::move(run.result());
}

}  // namespace gnomon
