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
  ShadowPasses passes;
  LightOnMap lit;
  TuningEvaluator evaluator;

  explicit View(const char* camera)
      : session({.validation = true}, {.scene = "near-far", .camera = camera, .size = "256"}),
        passes(session),
        lit(openLight(session, passes, *parseMaps("paraboloid").front(), {.side = 2048})),
        evaluator(lit) {}

  double error(const char* bias, float value) {  // of its first knob
    Method method = atDefaults(findBias(bias), session);
    method.params.knobs[0] = value;
    return static_cast<double>(evaluator.biasErrors(method)) / evaluator.scored();
  }
};

TEST(Figure7OfDou, NoConstantIsRightForTheBoxAndTheWallAtOnce) {
  View box("box"), wall("wall");
  double bestConstant = 1.0;
  for (double offset = 0.001; offset < 4.0; offset *= 1.3) {
    const auto value = static_cast<float>(offset);
    const double worse = std::max(box.error("constant", value), wall.error("constant", value));
    bestConstant = std::min(bestConstant, worse);
  }
  // The paper's K, and one offset for both: the larger of the two errors.
  const double adaptive = std::max(box.error("adaptive", 1e-4f), wall.error("adaptive", 1e-4f));
  const double dual = std::max(box.error("dual", 1.75f), wall.error("dual", 1.75f));
  EXPECT_GT(bestConstant, 0.02);
  EXPECT_LT(adaptive, bestConstant / 4.0);
  EXPECT_LT(dual, bestConstant / 20.0);
}

}  // namespace
}  // namespace gnomon
