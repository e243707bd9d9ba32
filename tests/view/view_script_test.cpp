#include "view/view_script.h"

#include "base/error.h"
#include "view/view_controls.h"

#include <functional>

#include <gtest/gtest.h>

namespace gnomon {

TEST(ViewScript, LinesAreReadAsTheyAreWritten) {
  const auto lines = parseScript(
      "s",
      "# a comment\n\n  drag 1 2 3 4 6\nset fog.density a file.vdb:grid\r\nscreenshot two words.png\nset b.bias\n");
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].verb, "drag");
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[0].words, (std::vector<std::string>{"1", "2", "3", "4", "6"}));
  EXPECT_EQ(lines[1].words, (std::vector<std::string>{"fog.density", "a file.vdb:grid"}));
  EXPECT_EQ(lines[2].words, (std::vector<std::string>{"two words.png"}));
  EXPECT_EQ(lines[3].words, (std::vector<std::string>{"b.bias"}));
  EXPECT_EQ(scriptNumber("s", lines[0], 3), 4.0);
}

std::string mistakeIn(const std::string& text) {
  try {
    for (const ScriptLine& line : parseScript("s", text))
      for (size_t i = 0; i < line.words.size(); ++i) scriptNumber("s", line, i);
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

TEST(ViewScript, CountsAndChoicesHaveBounds) {
  const ScriptLine line = parseScript("s", "drag 1 2.5 3 4 -3 middel\n").front();
  EXPECT_EQ(scriptCount("s", line, 0, 1, 9), 1);
  EXPECT_EQ(scriptChoice("s", line, 6, {"left", "right"}), 0u);
  for (const auto& wrong : {std::function<void()>([&] { scriptCount("s", line, 1, 1, 9); }),
                            std::function<void()>([&] { scriptCount("s", line, 4, 1, 9); }), std::function<void()>([&] {
                              scriptChoice("s", line, 5, {"left", "middle"});
                            })})
    EXPECT_THROW(wrong(), WorldError);
}

TEST(ViewScript, MistakesNameTheLine) {
  EXPECT_EQ(
      mistakeIn("wait-frames 3\nwait-frame 3\n"),
      "s:2: wait-frame: no such verb; did you mean wait-frames? Choose from " + [] {
        std::string names;
        for (const ScriptVerb& verb : scriptVerbs()) names += (names.empty() ? "" : ", ") + std::string(verb.name);
        return names;
      }());
  EXPECT_EQ(mistakeIn("move 1"), "s:1: write: move X Y");
  EXPECT_EQ(mistakeIn("move 1 2 3"), "s:1: write: move X Y");
  EXPECT_EQ(mistakeIn("move 1 up"), "s:1: up: is not a number");
}

}  // namespace gnomon
