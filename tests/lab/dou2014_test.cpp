// Dou et al., "Adaptive Depth Bias for Shadow Maps", 2014, figure 7 in kind: a near box and a far wall
// through one dual-paraboloid map.
#include "lab/compare/compare.h"
#include "lab/compare/tune.h"
#include "lab/core/maps.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

// One of the two views.
struct View {
  Session session;
  Passes passes;
  Exact exact;
  MapSet maps;
  Trial trial;

  explicit View(const char* camera)
      : session({.validation = true}, {.scene = "near-far", .camera = camera, .size = "256"}),
        passes(session.device(), session.view()),
        exact(computeExact(session, *parseMaps("paraboloid").front())),
        maps(session, passes.renderers, fitMap(session, *parseMaps("paraboloid").front(), exact, 2048, {}).fitted,
             exact, CullMode::Solids),
        trial(session, passes, exact, maps) {}

  double error(const char* bias, float glsl::BiasParams::*knob, float value) {
    Method method = methodFor(session, {}, findBias(bias));
    method.params.*knob = value;
    return static_cast<double>(trial.biasErrors(method)) / trial.scored();
  }
};

TEST(Figure7OfDou, NoConstantIsRightForTheBoxAndTheWallAtOnce) {
  View box("box"), wall("wall");
  double bestConstant = 1.0;
  for (double offset = 0.001; offset < 4.0; offset *= 1.3) {
    const auto value = static_cast<float>(offset);
    const double worse = std::max(box.error("constant", &glsl::BiasParams::constantOffset, value),
                                  wall.error("constant", &glsl::BiasParams::constantOffset, value));
    bestConstant = std::min(bestConstant, worse);
  }
  // The paper's K, and one offset for both: the larger of the two errors.
  const double adaptive = std::max(box.error("adaptive", &glsl::BiasParams::adaptiveK, 1e-4f),
                                   wall.error("adaptive", &glsl::BiasParams::adaptiveK, 1e-4f));
  const double dual = std::max(box.error("dual", &glsl::BiasParams::dualOffset, 1.75f),
                               wall.error("dual", &glsl::BiasParams::dualOffset, 1.75f));
  EXPECT_GT(bestConstant, 0.02);
  EXPECT_LT(adaptive, bestConstant / 4.0);
  EXPECT_LT(dual, bestConstant / 20.0);
}

}  // namespace
}  // namespace gnomon
