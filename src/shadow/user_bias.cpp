#include "shadow/user_bias.h"

#include "base/error.h"
#include "base/file.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

WorldError lineError(const UserBias& bias, int line, const std::string& what, const std::string& remedy) {
  return WorldError(fmt::format("{}:{}: {}; {}", bias.path, line, what, remedy));
}

Unit parseUnit(const UserBias& bias, int line, const std::string& word) {
  if (word == "metres") return Unit::Metres;
  if (word == "texels") return Unit::Texels;
  if (word == "one") return Unit::One;
  throw lineError(bias, line, fmt::format("'{}' is no unit", word), "write metres, texels or one");
}

void readKnob(UserBias& bias, int line, const std::string& text) {
  std::istringstream words(text);
  std::string unit, rest;
  BiasKnob knob{};
  words >> bias.knobName >> unit >> knob.lower >> knob.upper >> knob.defaultValue;
  if (!words || !(knob.lower <= knob.upper))
    throw lineError(bias, line, "the knob is not understood", "write //! knob: NAME UNIT LOWER UPPER DEFAULT [scene]");
  if (words >> rest && rest != "scene")
    throw lineError(bias, line, fmt::format("'{}' after the knob's default", rest), "write scene, or nothing");
  knob.unit = parseUnit(bias, line, unit);
  knob.defaultOfSceneScale = rest == "scene";
  knob.name = bias.knobName.c_str();
  bias.knobSentence = fmt::format("the knob of {}", bias.path);
  knob.sentence = bias.knobSentence.c_str();
  knob.field = &glsl::BiasParams::userKnob;
  knob.searchUpper = knob.upper;
  knob.searchLower = std::max(knob.lower, 1e-7f * knob.upper);
  bias.method.knobs = {knob};
}

void readLayers(UserBias& bias, int line, const std::string& text) {
  if (text == "1")
    bias.method.content = MapContent::OneLayer;
  else if (text == "2")
    bias.method.content = MapContent::TwoLayers;
  else if (text == "back")
    bias.method.content = MapContent::BackFaces;
  else
    throw lineError(bias, line, fmt::format("'{}' layers", text), "write 1, 2 or back");
}

void readHeader(UserBias& bias) {
  std::istringstream lines(bias.source);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = trimmed(line);
    if (!line.starts_with("//!")) continue;
    const std::string text = trimmed(line.substr(3));
    const size_t colon = text.find(':');
    const std::string key = text.substr(0, colon);
    const std::string value = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
    if (key == "name" && !value.empty())
      bias.name = value;
    else if (key == "sentence" && !value.empty())
      bias.sentence = value;
    else if (key == "layers")
      readLayers(bias, number, value);
    else if (key == "knob")
      readKnob(bias, number, value);
    else
      throw lineError(bias, number, fmt::format("'{}' is not understood", line),
                      "write //! name:, sentence:, layers: or knob:");
  }
}

}  // namespace

std::unique_ptr<const UserBias> loadUserBias(const std::filesystem::path& path) {
  return readUserBias(path, readFile(path));
}

std::unique_ptr<const UserBias> readUserBias(const std::filesystem::path& path, const std::string& source) {
  auto bias = std::make_unique<UserBias>();
  bias->path = path.string();
  bias->source = source;
  bias->name = path.stem().string();
  bias->sentence = "A bias of your own: " + bias->path;
  readHeader(*bias);
  for (const BiasMethod& method : biasMethods())
    if (bias->name == method.name)
      throw fileError(bias->path, fmt::format("'{}' is the name of a built-in bias", bias->name),
                      "rename the file, or write //! name: another");
  if (bias->name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") !=
          std::string::npos ||
      bias->name.starts_with('.'))
    throw fileError(bias->path, fmt::format("'{}' cannot name files", bias->name),
                    "take letters, digits, -, _ and . only");
  bias->method.id = glsl::kBiasUser;
  bias->method.name = bias->name.c_str();
  bias->method.sentence = bias->sentence.c_str();
  bias->method.user = bias.get();
  return bias;
}

}  // namespace gnomon
