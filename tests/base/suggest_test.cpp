// The name that was probably meant, and none where it is anybody's guess.
#include "base/suggest.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Suggest, FindsTheNearestName) {
  const std::vector<std::string> names = {"none", "constant", "slope", "adaptive", "adaptive-clamped", "cube"};
  EXPECT_EQ(nearestName("adpative", names), "adaptive");  // swapped
  EXPECT_EQ(nearestName("adaptve", names), "adaptive");   // missing
  EXPECT_EQ(nearestName("sloppe", names), "slope");       // extra
  EXPECT_EQ(nearestName("CUBE", names), "cube");
  EXPECT_EQ(nearestName("const", names), "constant");  // a beginning
  EXPECT_EQ(nearestName("adapt", names), "adaptive");  // of two the shorter one
}

TEST(Suggest, IsSilentWhereNothingIsNear) {
  const std::vector<std::string> names = {"none", "constant", "cube"};
  for (const char* word : {"", "x", "moire", "paraboloid", "c"}) EXPECT_EQ(nearestName(word, names), "") << word;
  EXPECT_EQ(nearestName(std::string(100000, 'c'), names), "");
  EXPECT_EQ(nearestName("cube", {}), "");
}

TEST(Suggest, ListsTheChoices) {
  EXPECT_EQ(chooseFrom("radail", "hyperbolic, radial"), "did you mean radial? Choose from hyperbolic, radial");
  EXPECT_EQ(chooseFrom("cubic", "hyperbolic, radial"), "choose from hyperbolic, radial");
}

}  // namespace
}  // namespace gnomon
