// What a medium's rows are judged by, on numbers small enough to work out by hand.
#include "lab/fog/fog_measure.h"
#include "lab/fog/density_sequence.h"
#include "lab/fog/fog_motion.h"
#include "lab/fog/fog_pictures.h"

#include "base/error.h"
#include "base/file.h"
#include "tests/base/temporary_folder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

ImageF imageOf(int width, int height, float value) {
  return ImageF(width, height, 3, value);
}

MediaRow row(const char* integrator, int steps, double buildMs, double integrateMs, double error) {
  return {.integrator = integrator,
          .steps = steps > 0 ? std::optional(steps) : std::nullopt,
          .isBaseline = steps > 0,
          .relRmse = error,
          .relRmse99 = 0.5 * error,
          .mapMs = buildMs,
          .integrateMs = integrateMs};
}

const EqualTerms& find(const std::vector<EqualTerms>& terms, bool withBuild, ErrorMeasure measure) {
  for (const EqualTerms& each : terms)
    if (each.withBuild == withBuild && each.measure == measure) return each;
  throw std::runtime_error("no such terms");
}

TEST(RelativeRmse, IsTheRootOfTheMeanSquareOverTheMean) {
  ImageF reference = imageOf(4, 5, 2.0f), measured = reference;
  EXPECT_EQ(relativeRmse(measured, reference), 0.0);
  measured.at(1, 2)[0] += 3.0f;
  measured.at(1, 2)[2] -= 4.0f;
  EXPECT_DOUBLE_EQ(relativeRmse(measured, reference), std::sqrt(25.0 / 60.0) / 2.0);
  measured.at(0, 0)[1] += 1.0f;
  // 19 of 20 pixels: without the worst one.
  EXPECT_DOUBLE_EQ(relativeRmse(measured, reference, 0.95), std::sqrt(1.0 / 57.0) / 2.0);
  EXPECT_EQ(relativeRmse(imageOf(2, 2, 0.0f), imageOf(2, 2, 0.0f)), 0.0);
  EXPECT_EQ(relativeRmse(imageOf(2, 2, 0.25f), imageOf(2, 2, 0.0f)), 0.25);  // absolute
}

// A pixel that follows the reference does not flicker, one that stands still or moves the other way does.
TEST(ChangeBeyond, ComparesSignedChanges) {
  const ImageF before = imageOf(2, 2, 1.0f), after = imageOf(2, 2, 3.0f);
  EXPECT_DOUBLE_EQ(changeBeyond(imageOf(2, 2, 5.0f), imageOf(2, 2, 7.0f), before, after), 0.0);
  EXPECT_DOUBLE_EQ(changeBeyond(before, before, before, after), 2.0);
  EXPECT_DOUBLE_EQ(changeBeyond(after, before, before, after), 4.0);
}

TEST(EqualTerms, AreReadOffTheMarchInLogLog) {
  // The march: error 1/steps, time 10 ms a step, build 20 ms.
  const std::vector<MediaRow> rows = {row("runs", 0, 80.0, 10.0, 0.02), row("march", 10, 0.0, 100.0, 0.1),
                                      row("march", 100, 0.0, 1000.0, 0.01)};
  const std::vector<EqualTerms> terms = equalTerms(rows);
  ASSERT_EQ(terms.size(), 4u);
  const EqualTerms& alone = find(terms, false, ErrorMeasure::RelRmse);
  // Error 0.02 takes the march 500 ms, on a line of slope -1.
  EXPECT_EQ(alone.faster.bound, Bound::Exact);
  EXPECT_NEAR(alone.faster.value, 50.0, 1e-9);
  // 10 ms is less than the march takes at all.
  EXPECT_EQ(alone.better.bound, Bound::AtLeast);
  EXPECT_NEAR(alone.better.value, 0.1 / 0.02, 1e-9);
  EXPECT_NEAR(find(terms, true, ErrorMeasure::RelRmse).faster.value, 500.0 / 90.0, 1e-9);
  // Both errors are halved in the other measure: the same line, shifted.
  EXPECT_NEAR(find(terms, false, ErrorMeasure::RelRmse99).faster.value, 50.0, 1e-9);
}

TEST(EqualTerms, SayWhichWayTheyLieBeyondTheCurve) {
  const std::vector<MediaRow> rows = {row("bits", 0, 0.0, 2000.0, 0.001), row("popcount", 0, 0.0, 200.0, 0.5),
                                      row("march", 10, 0.0, 100.0, 0.1), row("march", 100, 0.0, 1000.0, 0.01)};
  const std::vector<EqualTerms> terms = equalTerms(rows);
  const EqualTerms &bits = terms[2], &popcount = terms[6];
  EXPECT_EQ(bits.method(), "bits");
  EXPECT_EQ(bits.against, "march");
  EXPECT_EQ(bits.faster.bound, Bound::AtLeast);  // no march reaches 0.001
  EXPECT_DOUBLE_EQ(bits.faster.value, 0.5);
  EXPECT_EQ(bits.better.bound, Bound::AtMost);  // a march of more steps would fit into 2 s
  EXPECT_DOUBLE_EQ(bits.better.value, 10.0);
  EXPECT_EQ(popcount.method(), "popcount");
  EXPECT_EQ(popcount.faster.bound, Bound::AtMost);
  EXPECT_DOUBLE_EQ(popcount.faster.value, 0.5);
  EXPECT_EQ(popcount.better.bound, Bound::Exact);
  EXPECT_NEAR(popcount.better.value, 0.05 / 0.5, 1e-9);
  EXPECT_EQ(factorText(bits.faster), ">= 0.5");
  EXPECT_EQ(factorText(bits.better), "<= 10");
  EXPECT_EQ(factorText(popcount.better), "0.1");
}

TEST(EqualTerms, NeedAMarchAndAnError) {
  EXPECT_TRUE(equalTerms({row("runs", 0, 1.0, 1.0, 0.1)}).empty());
  MediaRow unscored = row("march", 32, 1.0, 1.0, 0.1);
  unscored.relRmse = unscored.relRmse99 = std::nullopt;
  EXPECT_TRUE(equalTerms({row("runs", 0, 1.0, 1.0, 0.1), unscored}).empty());
}

TEST(WorstMediaPlace, IsWhereErrorsAreLargeForTheirBrightness) {
  ImageF reference = imageOf(200, 150, 1.0f), measured = reference;
  reference.at(20, 20)[0] = 1000.0f;  // the light itself: off by more, and by less for what it is
  measured.at(20, 20)[0] = 1003.0f;
  measured.at(160, 120)[1] = 2.0f;
  const std::optional<WorstPlace> worst = worstMediaPlace(measured, reference);
  ASSERT_TRUE(worst.has_value());
  EXPECT_TRUE(worst->x <= 160 && worst->x + worst->size > 160);
  EXPECT_TRUE(worst->y <= 120 && worst->y + worst->size > 120);
  EXPECT_FALSE(worstMediaPlace(reference, reference).has_value());
  EXPECT_EQ(worstMediaPlace(imageOf(3, 2, 1.0f), imageOf(3, 2, 0.5f))->size, 2);
}

TEST(MediaDifferencePicture, IsBlueWhereLighterAndVermillionWhereDarker) {
  const ImageF reference = imageOf(3, 1, 0.5f);
  ImageF measured = reference;
  for (int c = 0; c < 3; ++c) {
    measured.at(0, 0)[c] += kFullDifference;
    measured.at(1, 0)[c] -= kFullDifference;
  }
  const Image8 picture = mediaDifferencePicture(measured, reference, {1.0f});
  EXPECT_GT(picture.at(0, 0)[2], picture.at(0, 0)[0] + 100);
  EXPECT_GT(picture.at(1, 0)[0], picture.at(1, 0)[2] + 100);
  EXPECT_EQ(picture.at(2, 0)[0], picture.at(2, 0)[2]);
}

TEST(Motion, RunsStraightFromTheFirstPlaceToTheLast) {
  const FogMotion motion = parseMotion("camera:2,0,-4", 5);
  EXPECT_TRUE(motion.camera);
  EXPECT_EQ(placeAt(motion, {1, 1, 1}, 0), glm::vec3(1, 1, 1));
  EXPECT_EQ(placeAt(motion, {1, 1, 1}, 2), glm::vec3(2, 1, -1));
  EXPECT_EQ(placeAt(motion, {1, 1, 1}, 4), glm::vec3(3, 1, -3));
  for (const char* text : {"", "lamp:1,0,0", "light", "light:1,0", "light:0,0,0", "orbit:y", "orbit:w,90", "orbit:y,0",
                           "orbit:0,0,0,90", "orbit:y,1e9", "orbit:90"})
    EXPECT_THROW(parseMotion(text, 5), UsageError) << text;
  EXPECT_THROW(parseMotion("light:1,0,0", 1), UsageError);
  EXPECT_THROW(parseMotion("light:1,0,0", kMostFrames + 1), UsageError);
}

TEST(Motion, AnOrbitGoesRoundTheCentreAndTurnsTheLightWithIt) {
  const FogMotion motion = parseMotion("orbit:y,180", 3);
  Light light;
  light.positionW = {3, 2, 0};
  light.directionW = {-1, 0, 0};
  const glm::vec3 centerW(1, 0, 0);
  const auto expectNear = [](const glm::vec3& a, const glm::vec3& b) { EXPECT_LT(glm::length(a - b), 1e-6f); };
  expectNear(lightAtFrame(motion, light, centerW, 0).positionW, {3, 2, 0});
  expectNear(lightAtFrame(motion, light, centerW, 1).positionW, {1, 2, -2});
  expectNear(lightAtFrame(motion, light, centerW, 1).directionW, {0, 0, 1});
  expectNear(lightAtFrame(motion, light, centerW, 2).positionW, {-1, 2, 0});
  const FogMotion tilted = parseMotion("orbit:0,0,2,90", 2);
  expectNear(lightAtFrame(tilted, light, centerW, 1).positionW, {-1, 2, 0});
}

TEST(DensitySequences, AreFilesByNumber) {
  const test::TemporaryFolder folder;
  for (const char* name : {"smoke.0007.vdb", "smoke.0008.vdb", "smoke.0009.vdb", "smoke.x.vdb"})
    writeTextFile(folder.path() / name, "");
  const std::string pattern = (folder.path() / "smoke.####.vdb").string();
  EXPECT_TRUE(DensitySequence::isOne(pattern));
  EXPECT_FALSE(DensitySequence::isOne("smoke.vdb:density"));
  const DensitySequence all(pattern + ":density", std::nullopt, 3);
  EXPECT_EQ(all.first(), 7);
  EXPECT_EQ(all.file(2), (folder.path() / "smoke.0009.vdb:density").string());
  EXPECT_EQ(DensitySequence(pattern, 8, 2).file(0), (folder.path() / "smoke.0008.vdb").string());
  EXPECT_THROW(DensitySequence(pattern, std::nullopt, 4), WorldError);
  EXPECT_THROW(DensitySequence((folder.path() / "fog.##.vdb").string(), std::nullopt, 2), WorldError);
  EXPECT_THROW(DensitySequence("a#b#.vdb", std::nullopt, 2), UsageError);
  EXPECT_THROW(DensitySequence(pattern, -1, 2), UsageError);
  EXPECT_FALSE(DensitySequence::isOne("take#3/smoke.vdb:density"));
  writeTextFile(folder.path() / "take#3.vdb", "");
  EXPECT_FALSE(DensitySequence::isOne((folder.path() / "take#3.vdb").string()));
}

}  // namespace
}  // namespace gnomon
