#include "lab/core/maps.h"
#include "lab/paper/reproduce_dou2014.h"

#include <array>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr std::array<const char*, 4> kMethods = {"constant", "slope", "adaptive", "dual"};

// Table 1, milliseconds on a GTX 580: Sponza, 20 thousand polygons, map and picture of 1024 x 1024.
struct PublishedTimes {
  double map, shading;
};
constexpr std::array<PublishedTimes, 4> kTable1 = {{{2.095, 4.232}, {2.112, 4.535}, {2.108, 5.211}, {4.716, 5.174}}};

std::vector<FrameKind> kindsOf(const std::vector<int>& sides) {
  std::vector<FrameKind> kinds;
  for (const int side : sides)
    for (const char* method : kMethods)
      kinds.push_back({.name = fmt::format("{} {}", method, side),
                       .bias = &findBias(method),
                       .filter = &filters().front(),
                       .mapSide = side});
  return kinds;
}

// What a method is answerable for.
double shadowMs(const FrameCost& cost) {
  return cost.mapMs + cost.visibilityMs;
}

void table1(PaperRun& run) {
  const Session& session = run.open("atrium", "lantern", "court", run.scaled(1024));
  const std::vector<FrameCost> costs = timeFrames(session, *parseMaps("spot").front(), kindsOf({run.scaled(1024)}),
                                                  run.options().repeats, run.progressTitle());
  PaperTable table{
      .id = "1",
      .title = "A frame's time",
      .note = fmt::format("Here: {}, {} triangles, spot map of {} × {} texels, {} × {} pixels; "
                          "shading is G-buffer, visibility and radiance. The paper: Sponza, 20 "
                          "thousand polygons, GeForce GTX 580. Ratios are of the whole frame.",
                          session.scene().name, triangleCount(session.scene()), run.scaled(1024), run.scaled(1024),
                          session.view().width, session.view().height),
      .columns = {"method", "paper: map ms", "shading ms", "overall ms", "to constant", "here: map ms", "shading ms",
                  "overall ms", "to constant", "of it visibility ms", "map and visibility, to constant"},
      .rows = {}};
  for (size_t i = 0; i < kMethods.size(); ++i) {
    const PublishedTimes& paper = kTable1[i];
    const double published = (paper.map + paper.shading) / (kTable1[0].map + kTable1[0].shading);
    run.number("published", kMethods[i], published);
    run.number("frame", kMethods[i], costs[i].ratio);
    run.number("shadow_ms", kMethods[i], shadowMs(costs[i]));
    run.number("map_ms", kMethods[i], costs[i].mapMs);
    run.number("shade_ms", kMethods[i], costs[i].shadeMs);
    table.rows.push_back({kMethods[i], fmt::format("{:.3f}", paper.map), fmt::format("{:.3f}", paper.shading),
                          fmt::format("{:.3f}", paper.map + paper.shading), fmt::format("{:.3f}", published),
                          fmt::format("{:.2f}", costs[i].mapMs), fmt::format("{:.2f}", costs[i].shadeMs),
                          fmt::format("{:.2f}", costs[i].frameMs), fmt::format("{:.3f}", costs[i].ratio),
                          fmt::format("{:.2f}", costs[i].visibilityMs),
                          fmt::format("{:.3f}", shadowMs(costs[i]) / shadowMs(costs[0]))});
  }
  run.addTable(std::move(table));
}

// A paraboloid is what the paper times. Two layers of two hemispheres take many seconds to draw with 8192
// texels a side on a CPU device, and more than 1 GiB: it ends at 4096, and a spot map goes on to 8192.
struct Curve {
  const char* map;
  int mostTexels;
};
constexpr std::array<Curve, 2> kCurves = {{{"paraboloid", 4096}, {"spot", 8192}}};
constexpr int kLeastTexels = 512;
constexpr int kMostRepeats = 3;  // a point of a curve needs less than a number in a table

void figure10(PaperRun& run) {
  const Session& session = run.open("atrium", "lantern", "court", run.scaled(1024));
  Figure figure{.id = "10",
                .title = "A frame's cost against the map's resolution",
                .setup = fmt::format(
                    "{}, {} triangles, {} × {} pixels; dual paraboloids of 512 to 4096 texels a side (8192 is left "
                    "out: drawing its two layers takes many seconds on a CPU device) and spot maps of 512 to 8192. The "
                    "paper's scene has 19 million polygons.",
                    session.scene().name, triangleCount(session.scene()), session.view().width, session.view().height),
                .panels = {},
                .svg = {}};
  std::vector<Growth> growths;
  PaperTable table{.id = "of figure 10",
                   .title = "A frame's cost against the map's resolution, ms, and as a ratio to the constant",
                   .note = figure.setup,
                   .columns = {"map, texels a side", "constant", "slope", "adaptive", "dual", "slope / constant",
                               "adaptive / constant", "dual / adaptive"},
                   .rows = {}};
  for (const Curve& curve : kCurves) {
    Growth growth{.size = fmt::format("the side of a {} map", curve.map), .unit = "texels", .stages = {}, .points = {}};
    growth.stages.assign(kMethods.begin(), kMethods.end());
    for (int full = kLeastTexels; full <= curve.mostTexels; full *= 2) {
      const int side = run.scaled(full);
      const std::vector<FrameCost> costs =
          timeFrames(session, *parseMaps(curve.map).front(), kindsOf({side}),
                     std::min(run.options().repeats, kMostRepeats), run.progressTitle());
      Growth::Point point{.size = static_cast<double>(side), .name = std::to_string(side), .ms = {}};
      std::vector<std::string> row = {fmt::format("{}, {}", curve.map, side)};
      for (size_t i = 0; i < kMethods.size(); ++i) {
        point.ms.push_back(costs[i].frameMs);
        row.push_back(fmt::format("{:.1f}", costs[i].frameMs));
        run.number("ratio", fmt::format("{} {} {}", curve.map, full, kMethods[i]), costs[i].ratio);
      }
      for (const double ratio : {costs[1].ratio, costs[2].ratio, costs[3].ratio / costs[2].ratio})
        row.push_back(fmt::format("{:.2f}", ratio));
      growth.points.push_back(std::move(point));
      table.rows.push_back(std::move(row));
    }
    growths.push_back(std::move(growth));
  }
  figure.svg = growthSvg(growths);
  run.addFigure(std::move(figure));
  run.addTable(std::move(table));
}

}  // namespace

void runDouTimes(PaperRun& run) {
  table1(run);
  figure10(run);
}

}  // namespace gnomon
