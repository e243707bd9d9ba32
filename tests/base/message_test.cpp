// What others wrote moves no cursor and begins no line.
#include "base/message.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(MessageTest, ControlCharactersAndBadBytesAreEscapedAndUtf8Stays) {
  EXPECT_EQ(printable("plain, caf\xc3\xa9, \xe6\x97\xa5, \xf0\x9f\x98\x80"),
            "plain, caf\xc3\xa9, \xe6\x97\xa5, \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31mred\x7f"), "\\x1b[31mred\\x7f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");                             // C1: a terminal's CSI
  EXPECT_EQ(printable("\xff\xc3("), "\\xff\\xc3(");                           // no UTF-8
  EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80"), "\\xc0\\xaf\\xed\\xa0\\x80");  // overlong, and a surrogate
  EXPECT_EQ(printable("\xe6\x97"), "\\xe6\\x97");                             // cut off
}

TEST(MessageTest, ALineIsOneAndShortAndWholeCharacters) {
  EXPECT_EQ(oneLine("first\nsecond"), "first");
  EXPECT_EQ(oneLine("ends. "), "ends");
  const std::string path(400, 'p');
  const std::string cut = oneLine(path + ": what; remedy");
  EXPECT_EQ(cut.size(), kLongestMessage);
  EXPECT_TRUE(cut.starts_with("ppp") && cut.ends_with(": what; remedy")) << cut;
  for (size_t front = 0; front < 3; ++front) {
    std::string wide(front, 'a');
    for (int i = 0; i < 200; ++i) wide += "\xe6\x97\xa5";
    EXPECT_LE(oneLine(wide).size(), kLongestMessage);
    EXPECT_EQ(printable(oneLine(wide)), oneLine(wide));
  }
  EXPECT_LE(oneLine(std::string(100'000'000, '\x1b')).size(), kLongestMessage);
}

}  // namespace
}  // namespace gnomon
