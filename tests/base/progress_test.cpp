// How long the rest will take.
#include "base/progress.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Progress, TellsWhatIsLeftOnceThereIsSomethingToJudgeBy) {
  EXPECT_EQ(remainingText(60.0, 0, 10), "");
  EXPECT_EQ(remainingText(1.0, 5, 10), "");  // over before it is read
  EXPECT_EQ(remainingText(10.0, 10, 10), "");
  EXPECT_EQ(remainingText(10.0, 2, 10), "about 40 s left");
  EXPECT_EQ(remainingText(60.0, 1, 11), "about 10 min left");
  EXPECT_EQ(remainingText(3600.0, 10, 110), "about 10.0 h left");
}

}  // namespace
}  // namespace gnomon
