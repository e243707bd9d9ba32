#include "lab/sweep/benchmark.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

// Sized so that two cores do it in half an hour: of 384 x 384 pixels one in a hundred thousand is a pixel and a half,
// and there are hundreds of cases; three sizes of map tell how an error falls with its texels. `crowd` at the size of
// the other scenes; a size of 19 million triangles would measure the machine.
constexpr const char* kWhole = R"({
  // Every generated scene, by the light of its own that each map takes and one at random, from its own camera and one
  // at random.
  "name": "Gnomon's benchmark, version 1",
  "seed": 20261126,
  "size": "384",
  "repeats": 1,
  "scenes": ["lshape", "double-torus", "factory", "atrium", "corner", "grate", "sheets", "contact", "tilted-planes",
             "near-far", "crowd:20000"],
  "lights": ["default", {"random": 1}],
  "cameras": ["default", {"random": 1}],
  "maps": ["cube", "paraboloid", "spot", "directional"],
  "map_sizes": [256, 512, 1024],
  "biases": ["all"],
  "filters": ["none"],
  "worst_pictures": 10
})";

constexpr const char* kQuick = R"({
  // A share of the whole: the same lights and cameras, fewer of them.
  "name": "Gnomon's benchmark, version 1, quick",
  "seed": 20261126,
  "size": "384",
  "repeats": 1,
  "scenes": ["factory", "atrium", "sheets", "contact", "near-far"],
  "lights": ["default"],
  "cameras": ["default", {"random": 1}],
  "maps": ["cube", "directional"],
  "map_sizes": [256, 1024],
  "biases": ["all"],
  "filters": ["none"],
  "worst_pictures": 5
})";

}  // namespace

Plan benchmarkPlan(bool quick) {
  return parsePlan(quick ? "quick benchmark" : "benchmark", quick ? kQuick : kWhole);
}

}  // namespace gnomon
