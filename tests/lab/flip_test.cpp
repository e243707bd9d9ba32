// FLIP against the values of the authors' own program, LDR-FLIP 1.6 at its default viewing conditions.
#include "lab/picture/flip.h"
#include "base/error.h"
#include "base/file.h"

#include "tests/base/places.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

Image8 load(const std::string& name) {
  const std::string path = test::inSource(GNOMON_TEST_FOLDER) + "/flip/" + name + ".png";
  const std::string bytes = readFile(path);
  return decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), path);
}

struct Published {
  const char* reference;
  const char* test;
  double mean, weightedMedian, firstWeightedQuartile, thirdWeightedQuartile, max;
};
constexpr Published kPublished[] = {
    {"checker", "checker_blur", 0.202292, 0.255559, 0.217225, 0.352207, 0.437527},
    {"ramp", "ramp_shift", 0.089298, 0.105526, 0.086302, 0.118109, 0.141904},
    {"boxes", "boxes_moved", 0.005995, 0.558523, 0.414604, 0.691730, 0.726052},
    {"checker", "ramp", 0.938804, 0.973903, 0.941021, 0.980129, 0.996085},
};

TEST(Flip, HasTheValuesOfTheAuthorsProgram) {
  for (const Published& published : kPublished) {
    SCOPED_TRACE(std::string(published.reference) + " " + published.test);
    const Flip flip = computeFlip(load(published.reference), load(published.test));
    // Ours differ from six published digits by up to 9e-6: floats, and another order of their sums.
    EXPECT_NEAR(flip.mean, published.mean, 2e-5);
    EXPECT_NEAR(flip.weightedMedian, published.weightedMedian, 1e-5);
    EXPECT_NEAR(flip.firstWeightedQuartile, published.firstWeightedQuartile, 1e-5);
    EXPECT_NEAR(flip.thirdWeightedQuartile, published.thirdWeightedQuartile, 1e-5);
    EXPECT_NEAR(flip.max, published.max, 2e-6);
  }
}

TEST(Flip, TheMapHasTheAuthorsColors) {
  const Image8 map = flipPicture(computeFlip(load("boxes"), load("boxes_moved")).map);
  const Image8 expected = load("expected_map_boxes");
  ASSERT_EQ(map.width, expected.width);
  ASSERT_EQ(map.height, expected.height);
  size_t differing = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      for (int c = 0; c < 3; ++c) differing += map.at(x, y)[c] != expected.at(x, y)[c] ? 1 : 0;
  EXPECT_EQ(differing, 0u);
}

TEST(Flip, EqualPicturesDifferNowhere) {
  const Image8 boxes = load("boxes");
  const Flip flip = computeFlip(boxes, boxes);
  EXPECT_EQ(flip.mean, 0.0);
  EXPECT_EQ(flip.weightedMedian, 0.0);
  EXPECT_EQ(flip.thirdWeightedQuartile, 0.0);
  EXPECT_EQ(flip.max, 0.0);
}

TEST(Flip, DoesNotTellReferenceFromTest) {
  const Image8 a = load("checker");
  const Image8 b = load("ramp");
  const Flip forth = computeFlip(a, b);
  const Flip back = computeFlip(b, a);
  for (size_t i = 0; i < forth.map.values.size(); ++i) ASSERT_NEAR(forth.map.values[i], back.map.values[i], 1e-6f);
}

TEST(Flip, BlackAgainstWhiteIsNearlyOneAndGreyNeedsOneChannel) {
  const Flip grey = computeFlip(Image8(40, 30, 1, 0), Image8(40, 30, 1, 255));
  const Flip color = computeFlip(Image8(40, 30, 3, 0), Image8(40, 30, 4, 255));
  EXPECT_EQ(grey.mean, color.mean);
  EXPECT_GT(grey.mean, 0.95);
  EXPECT_LE(grey.max, 1.0);
}

TEST(Flip, AFarEyeDoesNotSeeFineStripes) {
  Image8 stripes(64, 64, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) *stripes.at(x, y) = x % 4 < 2 ? 255 : 0;
  const Image8 grey(64, 64, 1, 188);  // half of white's light
  EXPECT_GT(computeFlip(stripes, grey, 10.0).mean, 0.5);
  EXPECT_LT(computeFlip(stripes, grey, 200.0).mean, 0.2);
}

TEST(Flip, RefusesPicturesOfDifferentSizes) {
  EXPECT_THROW(computeFlip(Image8(4, 4, 3), Image8(4, 5, 3)), WorldError);
  EXPECT_THROW(computeFlip(Image8(4, 4, 3), Image8(5, 4, 3)), WorldError);
  EXPECT_THROW(computeFlip(Image8(), Image8()), WorldError);
  EXPECT_THROW(computeFlip(Image8(4, 4, 2), Image8(4, 4, 2)), WorldError);
}

TEST(FlipPicture, GoesFromBlackToPaleYellow) {
  ImageF map(4, 1, 1);
  map.values = {0.0f, 0.5f, 1.0f, 2.0f};
  const Image8 picture = flipPicture(map);
  EXPECT_EQ(picture.at(0, 0)[0], 0);
  EXPECT_EQ(picture.at(2, 0)[0], 252);
  EXPECT_EQ(picture.at(3, 0)[2], picture.at(2, 0)[2]);
  EXPECT_GT(picture.at(1, 0)[0], picture.at(1, 0)[1]);
}

}  // namespace
}  // namespace gnomon
