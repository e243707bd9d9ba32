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
        passes_(session_.device(), session_.view()),
        spot_(*parseMaps("spot").front()),
        exact_(computeExact(session_, spot_)),
        maps_(session_, passes_.renderers, fitMap(session_, spot_, exact_, 64, {}).fitted, exact_, CullMode::Solids),
        trial_(session_, passes_, exact_, maps_) {}

  Method method(const char* name) { return methodFor(session_, {}, findBias(name)); }

  Session session_;
  Passes passes_;
  const Parameterization& spot_;
  Exact exact_;
  MapSet maps_;
  Trial trial_;
};

// In an order that meets the same pixels again with other texels, and with the same.
TEST_F(TuneTest, ErrorsAreThoseOfTheLabels) {
  for (const char* name : {"constant", "normal-offset", "dual", "slope", "normal-offset", "constant"}) {
    for (const float share : {0.0f, 1.0f, 8.0f, 0.3f}) {
      Method m = method(name);
      m.params.knobs[0] *= share;
      const Judged judged = judge(session_, passes_, maps_.with(m.bias->channels), exact_, m);
      EXPECT_EQ(trial_.biasErrors(m), judged.labels.count(Label::Acne) + judged.labels.count(Label::Leak))
          << name << " " << share;
    }
  }
}

TEST_F(TuneTest, NothingNearbyIsBetter) {
  for (const char* name : {"constant", "slope", "normal-offset", "cosine", "dual", "adaptive"}) {
    const Method start = method(name);
    const TunedMethod tuned = tune(trial_, start);
    EXPECT_LE(tuned.biasErrors, trial_.biasErrors(start)) << name;
    for (const Knob& knob : knobsOf(*start.bias)) {
      const float unit = knob.defaultOfSceneScale ? trial_.sceneScale() : 1.0f;
      for (int i = 0; i < kTuneGrid; ++i) {
        Method other = tuned.method;
        const double t = static_cast<double>(i) / (kTuneGrid - 1);
        valueOf(other.params, *other.bias, knob) =
            static_cast<float>(knob.searchLower * std::pow(knob.searchUpper / knob.searchLower, t) * unit);
        EXPECT_LE(tuned.biasErrors, trial_.biasErrors(other)) << name << " " << knob.name << " " << i;
      }
    }
  }
}

TEST_F(TuneTest, ItIsWorthItAndTheSameEveryTime) {
  const TunedMethod a = tune(trial_, method("constant"));
  Trial again(session_, passes_, exact_, maps_);
  const TunedMethod b = tune(again, method("constant"));
  EXPECT_EQ(a.method.params.knobs[0], b.method.params.knobs[0]);
  EXPECT_EQ(a.biasErrors, b.biasErrors);
  EXPECT_LT(a.biasErrors, trial_.biasErrors(method("none")) / 4);
}

TEST_F(TuneTest, RobustnessIsNeverBetterThanTheBestThere) {
  CompareOptions options;
  options.mapSide = 64;
  Robustness robustness(session_, exact_, options, spot_);
  const TunedMethod tuned = tune(trial_, method("constant"));
  const Tuning tuning = robustness.judge(tuned);
  EXPECT_STREQ(tuning.knob.c_str(), "offset");
  ASSERT_TRUE(tuning.otherCamera && tuning.otherMapSize);
  for (const Elsewhere* elsewhere : {&*tuning.otherCamera, &*tuning.otherMapSize}) {
    EXPECT_GE(elsewhere->biasError, elsewhere->bestBiasError);
    EXPECT_GT(elsewhere->bestValue, 0.0);
  }
  EXPECT_EQ(tuning.otherMapSide, 32);
  // A constant tuned for small texels is too small for large ones.
  EXPECT_GT(tuning.otherMapSize->biasError, tuning.otherMapSize->bestBiasError);
}

TEST_F(TuneTest, TheOtherCameraSeesTheSamePlaceFromAside) {
  const Camera other = orbitedCamera(session_);
  const glm::vec3 before(session_.view().eyeW);
  const Session there(session_, other);
  EXPECT_GT(glm::distance(before, there.view().eyeW), 0.1f);
  EXPECT_EQ(there.view().width, session_.view().width);
  EXPECT_GT(traceExact(there, exact_.source, exact_.light).receivers.scored, size_t{1000});
}

}  // namespace
}  // namespace gnomon
