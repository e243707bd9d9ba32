// Words, and comments: they are what the compiler takes for comments, and everything else keeps its place.
#include "gpu/glsl_comments.h"
#include "gpu/glsl_words.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon::gpu {
namespace {

TEST(GlslComments, EndWhereTheLineEndsOrWhereTheySay) {
  EXPECT_EQ(blankComments("a // b\nc"), "a     \nc");
  EXPECT_EQ(blankComments("a /* b */ c"), "a         c");
  EXPECT_EQ(blankComments("a/**/b/*/ c */d"), "a    b        d");
  EXPECT_EQ(blankComments("/* a *//* b */// c\nd"), "                  \nd");
  EXPECT_EQ(blankComments("a / b * c /d/ e */ f"), "a / b * c /d/ e */ f");
  EXPECT_EQ(blankComments("// a"), "    ");
  EXPECT_EQ(blankComments(""), "");
}

TEST(GlslComments, LineBreaksInThemStayOrBecomeBlanks) {
  const std::string text = "a /* b\n\r\n\r*/ c // d\\\ne\nf";
  EXPECT_EQ(blankComments(text), "a     \n\r\n\r   c      \n \nf");
  EXPECT_EQ(blankComments(text, CommentBreaks::Blanked), "a            c        \nf");
}

TEST(GlslComments, GoOnBehindABackslash) {
  EXPECT_EQ(blankComments("// a \\\nb\nc"), "      \n \nc");
  EXPECT_EQ(blankComments("// a \\\r\nb\r\nc"), "      \r\n \r\nc");
  EXPECT_EQ(blankComments("// a \\\rb\rc"), "      \r \rc");
  EXPECT_EQ(blankComments("// a \\\\\n\\\n\nb"), "       \n \n\nb");
  EXPECT_EQ(blankComments("// a \\ b\nc"), "        \nc");
  EXPECT_EQ(blankComments("// a \\"), "      ");
  EXPECT_EQ(blankComments("a \\\nb"), "a \\\nb");
}

TEST(GlslComments, DoNotBeginWithinOneOfTheOtherKind) {
  EXPECT_EQ(blankComments("// /*\na // */\nb"), "     \na      \nb");
  EXPECT_EQ(blankComments("/* // */ a"), "         a");
  EXPECT_EQ(blankComments("// a \\\n/* b\nc */"), "      \n    \nc */");
}

TEST(GlslComments, EndWithALineOfWindowsOrOfAnOldMac) {
  EXPECT_EQ(blankComments("a // b\r\nc"), "a     \r\nc");
  EXPECT_EQ(blankComments("a // b\rc // d\re"), "a     \rc     \re");
}

TEST(GlslComments, WithoutAnEndReachToTheEndOfTheText) {
  EXPECT_EQ(blankComments("a /* b\nc"), "a     \n ");
  EXPECT_EQ(blankComments("a /*"), "a   ");
  EXPECT_EQ(blankComments("a /*/"), "a    ");
}

TEST(GlslWords, AreNamesNumbersAndSingleCharacters) {
  std::vector<std::string> texts;
  for (const Word& word : wordsOf("a1.b /* c\n d */ += 1.5e-3f // e\n.5"))
    texts.push_back(fmt::format("{}:{}", word.text, word.line));
  EXPECT_EQ(texts, (std::vector<std::string>{"a1:1", ".:1", "b:1", "+:2", "=:2", "1.5e-3f:2", ".5:3"}));
}

}  // namespace
}  // namespace gnomon::gpu
