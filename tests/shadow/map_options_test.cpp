// Options that declare themselves: read by type, told by name, written so that they are read again.
#include "shadow/map_options.h"

#include "base/error.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

enum class Colour { Red, Green };

constinit const ChoiceOption<Colour> kColour({.name = "my_colour", .sentence = "what it looks like", .unit = "hue"},
                                             Colour::Green,
                                             {{Colour::Red, "red", "as blood"}, {Colour::Green, "green", "as grass"}});
constinit const NumberOption kCount({.name = "count", .sentence = "how many"}, 3, 1, 9);

std::string complaintOf(const MapOption& option, const std::string& text) {
  try {
    option.parsed(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(MapOptions, AreAtTheirDefaultsUntilTheyAreSetAndAgainWhenSetBack) {
  MapOptions options;
  EXPECT_EQ(options.get(kColour), Colour::Green);
  EXPECT_EQ(options.get(kCount), 3);
  options.set(kColour(Colour::Red));
  EXPECT_EQ(options.get(kColour), Colour::Red);
  EXPECT_EQ(options.get(kCount), 3);
  EXPECT_NE(options, MapOptions());
  options.set(kColour(Colour::Green));
  EXPECT_EQ(options, MapOptions());
  EXPECT_TRUE(options.choices().empty());
}

TEST(MapOptions, AreValues) {
  const MapOptions one = {kCount(5), kColour(Colour::Red)}, same = {kColour(Colour::Red), kCount(5)};
  EXPECT_EQ(one, same);
  EXPECT_FALSE(one < same || same < one);
  const MapOptions other = one.with(kCount(6));
  EXPECT_EQ(one.get(kCount), 5);
  EXPECT_EQ(other.get(kCount), 6);
  EXPECT_EQ(other.get(kColour), Colour::Red);
  EXPECT_TRUE((one < other) != (other < one));
}

TEST(MapOptions, WriteWhatTheyReadAndSayWhatTheyCannot) {
  EXPECT_EQ(kColour.flag(), "--my-colour");
  EXPECT_EQ(kColour.help(), "what it looks like [hue]. red: as blood; green: as grass");
  EXPECT_EQ(kCount.help(), "how many. 1..9");
  for (const char* text : {"red", "green"}) EXPECT_EQ(kColour.text(kColour.parse(text)), text);
  EXPECT_EQ(kCount.text(kCount.parse("7")), "7");
  EXPECT_EQ(complaintOf(kColour, "blue"), "--my-colour blue: no such choice; choose from red, green");
  EXPECT_EQ(complaintOf(kCount, "10"), "--count 10: is outside 1..9");
  for (const char* text : {"", "x", "3.5", "3 "})
    EXPECT_EQ(complaintOf(kCount, text), "--count " + std::string(text) + ": write a whole number of 1..9");
  EXPECT_EQ(kColour.told({kColour(Colour::Red)}), "red");
  EXPECT_EQ(kColour.told({}), "green");
}

}  // namespace
}  // namespace gnomon
