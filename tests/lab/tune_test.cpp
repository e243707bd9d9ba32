// The search for the best knob: what it counts is what the labels count, and nothing it has seen is better
// than what it says.
#include "lab/compare/tune.h"
#include "lab/compare/compare.h"
#include "lab/compare/robustness.h"
#include "lab/core/maps.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

class TuneTest : public ::testing::Test {
 protected:
  TuneTest()
      : session_({.validation = true}, {.scene = "contact", .size = "160"}),
        passes_(session_),
        lit_(openLight(session_, passes_, *parseMaps("spot").front(), {.side = 64})),
        evaluator_(lit_) {}

  Method method(const char* name) { return atDefaults(findBias(name), session_); }

  Session session_;
  ShadowPasses passes_;
  LightOnMap lit_;
  TuningEvaluator evaluator_;
};

// In an order that meets the same pixels again with other texels, and with the same.
TEST_F(TuneTest, ErrorsAreThoseOfTheLabels) {
  for (const char* name : {"constant", "normal-offset", "dual", "slope", "normal-offset", "constant"}) {
    for (const float share : {0.0f, 1.0f, 8.0f, 0.3f}) {
      Method m = method(name);
      m.params.knobs[0] *= share;
      const LabelledResult judged = lit_.judge(m);
      EXPECT_EQ(evaluator_.biasErrors(m), judged.labels.count(Label::Acne) + judged.labels.count(Label::Leak))
          << name << " " << share;
    }
  }
}

TEST_F(TuneTest, NothingNearbyIsBetter) {
  for (const char* name : {"constant", "slope", "normal-offset", "cosine", "dual", "adaptive"}) {
    const Method start = method(name);
    const TunedMethod tuned = tune(evaluator_, start);
    EXPECT_LE(tuned.biasErrors, evaluator_.biasErrors(start)) << name;
    for (const Knob& knob : knobsOf(*start.bias)) {
      const float unit = knob.defaultOfSceneScale ? evaluator_.sceneScale() : 1.0f;
      for (int i = 0; i < kTuneGrid; ++i) {
        Method other = tuned.method;
        const double t = static_cast<double>(i) / (kTuneGrid - 1);
        valueOf(other.params, *other.bias, knob) =
            static_cast<float>(knob.searchLower * std::pow(knob.searchUpper / knob.searchLower, t) * unit);
        EXPECT_LE(tuned.biasErrors, evaluator_.biasErrors(other)) << name << " " << knob.name << " " << i;
      }
    }
  }
}

TEST_F(TuneTest, ItIsWorthItAndTheSameEveryTime) {
  const TunedMethod a = tune(evaluator_, method("constant"));
  TuningEvaluator again(lit_);
  const TunedMethod b = tune(again, method("constant"));
  EXPECT_EQ(a.method.params.knobs[0], b.method.params.knobs[0]);
  EXPECT_EQ(a.biasErrors, b.biasErrors);
  EXPECT_LT(a.biasErrors, evaluator_.biasErrors(method("none")) / 4);
}

TEST_F(TuneTest, RobustnessIsNeverBetterThanTheBestThere) {
  CompareOptions options;
  options.mapSide = 64;
  Robustness robustness(lit_, options);
  const TunedMethod tuned = tune(evaluator_, method("constant"));
  const Tuning tuning = robustness.judge(tuned);
  EXPECT_STREQ(tuning.knob.c_str(), "offset");
  ASSERT_TRUE(tuning.otherCamera && tuning.otherMapSize);
  for (const Transfer* transfer :
       {static_cast<const Transfer*>(&*tuning.otherCamera), static_cast<const Transfer*>(&*tuning.otherMapSize)}) {
    EXPECT_GE(transfer->biasError, transfer->bestBiasError);
    EXPECT_GT(transfer->bestValue, 0.0);
  }
  EXPECT_EQ(tuning.otherMapSize->mapSize, 32);
  // A constant tuned for small texels is too small for large ones.
  EXPECT_GT(tuning.otherMapSize->biasError, tuning.otherMapSize->bestBiasError);
}

TEST_F(TuneTest, TheOtherCameraSeesTheSamePlaceFromAside) {
  const Camera other = orbitedCamera(session_);
  const glm::vec3 before(session_.view().eyeW);
  const SceneView there(session_, other);
  EXPECT_GT(glm::distance(before, there.view().eyeW), 0.1f);
  EXPECT_EQ(there.view().width, session_.view().width);
  EXPECT_GT(traceGroundTruth(there, lit_.source(), lit_.light()).receivers.scored, size_t{1000});
}

}  // namespace
}  // namespace gnomon
