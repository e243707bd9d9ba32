#pragma once
// Golden pictures, beside the tests in golden/. Blessed by tools/bless, in a commit of its own. On lavapipe they are
// equal to the bit; another device may differ in half a percent of the pixels, at decisions within its rounding.

#include "base/image.h"

#include "tests/base/places.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <span>
#include <string>

namespace gnomon::test {

// One value a pixel of a square picture, lit above one half.
inline void compareWithGolden(const std::string& name, std::span<const float> visibility, int side, bool exact) {
  Image8 picture(side, side, 1);
  ASSERT_EQ(visibility.size(), picture.values.size());
  for (size_t i = 0; i < visibility.size(); ++i) picture.values[i] = visibility[i] > 0.5f ? 255 : 0;
  const std::filesystem::path path =
      std::filesystem::path(test::inSource(GNOMON_TEST_FOLDER)) / "golden" / (name + ".png");
  if (std::getenv("GNOMON_BLESS") != nullptr) writePng(path, picture);
  const ImageF golden = readImage(path);
  ASSERT_EQ(golden.values.size(), picture.values.size());
  size_t different = 0;
  for (size_t i = 0; i < golden.values.size(); ++i)
    different += (golden.values[i] > 0.5f) != (picture.values[i] > 127) ? 1 : 0;
  EXPECT_LE(different, exact ? size_t{0} : golden.values.size() / 200) << name;
}

}  // namespace gnomon::test
