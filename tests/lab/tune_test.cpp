// The search for the best knob: what it counts is what the labels count, and nothing it has seen is better
// than what it says.
#include "lab/compare/tune.h"
#include "judge/filtered_truth.h"
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
    EXPECT_LE(tuned.error, evaluator_.error(start)) << name;
    for (const Knob& knob : knobsOf(*start.bias)) {
      const float unit = knob.defaultOfSceneScale ? evaluator_.sceneScale() : 1.0f;
      for (int i = 0; i < kTuneGrid; ++i) {
        Method other = tuned.method;
        const double t = static_cast<double>(i) / (kTuneGrid - 1);
        valueOf(other.params, *other.bias, knob) =
            static_cast<float>(knob.searchLower * std::pow(knob.searchUpper / knob.searchLower, t) * unit);
        EXPECT_LE(tuned.error, evaluator_.error(other)) << name << " " << knob.name << " " << i;
      }
    }
  }
}

TEST_F(TuneTest, ItIsWorthItAndTheSameEveryTime) {
  const TunedMethod a = tune(evaluator_, method("constant"));
  TuningEvaluator again(lit_);
  const TunedMethod b = tune(again, method("constant"));
  EXPECT_EQ(a.method.params.knobs[0], b.method.params.knobs[0]);
  EXPECT_EQ(a.error, b.error);
  EXPECT_LT(a.error, evaluator_.error(method("none")) / 4);
}

// Through a filter the RMSE counts, and a wide filter wants another value than the unfiltered map does.
TEST_F(TuneTest, AFilterIsTunedForItsOwnError) {
  const ChosenFilter filter(glsl::kShadowFilterJitter4x4);
  TuningEvaluator filtered(lit_, filter);
  const std::vector<float> truth = lit_.filteredTruth(filter);
  for (const char* name : {"constant", "normal-offset", "adaptive"}) {
    const TunedMethod unfiltered = tune(evaluator_, method(name));
    const TunedMethod tuned = tune(filtered, method(name));
    EXPECT_LT(tuned.error, filtered.error(unfiltered.method)) << name;
    EXPECT_GT(tuned.method.params.knobs[0], unfiltered.method.params.knobs[0]) << name;
    EXPECT_DOUBLE_EQ(tuned.error, scoredRmse(lit_.receivers(), lit_.visibility(tuned.method, filter), truth)) << name;
  }
}

TEST_F(TuneTest, AMethodElsewhereIsWhatItsLabelsSayThere) {
  CompareOptions options;
  options.mapSide = 64;
  const Elsewhere elsewhere =
      Robustness(lit_, options).judge(method("constant"), ChosenFilter(glsl::kShadowFilterBilinear));
  ASSERT_TRUE(elsewhere.otherCamera && elsewhere.otherMapSize);
  EXPECT_EQ(elsewhere.otherMapSize->mapSize, 32);
  LightOnMap halved(lit_, {.side = 32});
  const LabelledResult judged = halved.judge(method("constant"));
  const auto share = [&](size_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(halved.receivers().scored);
  };
  EXPECT_DOUBLE_EQ(elsewhere.otherMapSize->biasError,
                   share(judged.labels.count(Label::Acne) + judged.labels.count(Label::Leak)));
  EXPECT_DOUBLE_EQ(elsewhere.otherMapSize->allWrong,
                   share(halved.receivers().scored - judged.labels.count(Label::Agree)));
  EXPECT_GT(elsewhere.otherMapSize->rmse.value_or(0.0), 0.0);
  EXPECT_NE(elsewhere.otherCamera->allWrong, elsewhere.otherMapSize->allWrong);
}

// Pixels of all lights are added up before a share is taken; the same light twice is as wrong as once.
TEST_F(TuneTest, ErrorsElsewhereOfSeveralLightsAreOfAllTheirPixels) {
  ErrorCount bright{.scored = 900, .biasErrors = 9, .wrong = 18, .squares = 9.0};
  const ErrorCount dim{.scored = 100, .biasErrors = 11, .wrong = 22, .squares = 1.0};
  bright += dim;
  ErrorElsewhere there;
  bright.tell(there);
  EXPECT_DOUBLE_EQ(there.biasError, 0.02);
  EXPECT_DOUBLE_EQ(there.allWrong, 0.04);
  EXPECT_DOUBLE_EQ(there.rmse.value_or(0.0), 0.1);
  CompareOptions options;
  options.mapSide = 64;
  Robustness robustness(lit_, options);
  Robustness::Counts counts;
  const Elsewhere once = robustness.judge(method("constant"), ChosenFilter(glsl::kShadowFilterNone), counts);
  const Elsewhere twice = robustness.judge(method("constant"), ChosenFilter(glsl::kShadowFilterNone), counts);
  EXPECT_GT(once.otherMapSize->biasError, 0.0);
  EXPECT_DOUBLE_EQ(twice.otherMapSize->biasError, once.otherMapSize->biasError);
  EXPECT_EQ(counts.otherMapSize.scored, 2 * LightOnMap(lit_, {.side = 32}).receivers().scored);
}

TEST_F(TuneTest, RobustnessIsNeverBetterThanTheBestThere) {
  CompareOptions options;
  options.mapSide = 64;
  Robustness robustness(lit_, options);
  const TunedMethod tuned = tune(evaluator_, method("constant"));
  const Tuning tuning = robustness.judge(tuned, glsl::kShadowFilterNone);
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
