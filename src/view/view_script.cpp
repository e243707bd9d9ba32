#include "view/view_script.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/parse.h"
#include "base/suggest.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

[[noreturn]] void fail(const std::string& name, int line, const std::string& what) {
  throw WorldError(fmt::format("{}:{}: {}", name, line, what));
}

std::string verbNames() {
  std::string names;
  for (const ScriptVerb& verb : scriptVerbs()) names += (names.empty() ? "" : ", ") + std::string(verb.name);
  return names;
}

}  // namespace

const std::vector<ScriptVerb>& scriptVerbs() {
  static const std::vector<ScriptVerb> all = {
      {"key", 1, 1, false, "[ctrl+][shift+]KEY", "presses a key: a letter, a digit, tab, f1, left, ..."},
      {"hold", 2, 2, false, "KEY FRAMES", "holds a key down"},
      {"move", 2, 2, false, "X Y", "moves the mouse, pixels of the picture from its upper left"},
      {"down", 0, 1, false, "[BUTTON]", "presses a mouse button: left, right, middle"},
      {"up", 0, 1, false, "[BUTTON]", "lets it go"},
      {"drag", 4, 6, false, "X0 Y0 X1 Y1 [STEPS [BUTTON]]", "presses, moves in so many steps, and lets go"},
      {"scroll", 1, 1, false, "LINES", "turns the wheel"},
      {"window-move", 2, 2, false, "X Y", "moves the mouse, pixels of the window"},
      {"drop", 1, 1, true, "FILE", "drops a file on the window"},
      {"set", 1, 2, true, "NAME [VALUE]", "sets a control (`controls` lists them); without a value: to nothing"},
      {"expect", 1, 2, true, "NAME [VALUE]", "fails unless the control has that value"},
      {"expect-problem", 0, 1, true, "[TEXT]",
       "fails unless the window shows a problem with that text; none: unless it shows none"},
      {"controls", 0, 0, false, "", "prints all controls and their values"},
      {"command", 0, 0, false, "", "prints the command line of the status line"},
      {"wait-frames", 1, 1, false, "N", "draws the window N times"},
      {"wait-refined", 0, 0, false, "", "waits until nothing is left to draw"},
      {"wait-ready", 0, 0, false, "", "and until the first picture that moves is prepared"},
      {"animate", 3, 3, false, "light|camera DEGREES PICTURES", "turns it round the scene's centre, and measures"},
      {"rest", 1, 1, false, "FRAMES", "draws the window so often while nothing moves, and measures"},
      {"picture", 1, 2, false, "FILE [a|b]", "writes the picture as `gnomon render` does"},
      {"screenshot", 1, 1, true, "FILE", "writes the whole window"},
      {"turntable", 2, 3, false, "FOLDER FRAMES [light|camera]",
       "writes a turn round the scene's centre, and a video where ffmpeg is"},
      {"save", 1, 1, true, "FILE", "saves the session"},
      {"undo", 0, 0, false, "", "takes back the last change"},
      {"redo", 0, 0, false, "", "makes it again"},
      {"resize", 2, 2, false, "WIDTH HEIGHT", "of the window"},
      {"minimise", 0, 0, false, "", "the window"},
      {"restore", 0, 0, false, "", "it"},
      {"lose-device", 0, 1, false, "[window]", "as if the drawing device were lost, or the window's"},
      {"random", 1, 2, false, "FRAMES [SEED]", "plays so many frames of random input"},
      {"memory", 1, 1, false, "NAME", "prints the program's resident memory, MiB"},
      {"quit", 0, 0, false, "", "ends the program"}};
  return all;
}

std::vector<ScriptLine> parseScript(const std::string& name, const std::string& text) {
  std::vector<ScriptLine> lines;
  std::istringstream in(text);
  int number = 0;
  for (std::string raw; std::getline(in, raw);) {
    ++number;
    if (!raw.empty() && raw.back() == '\r') raw.pop_back();
    const size_t begin = raw.find_first_not_of(" \t");
    if (begin == std::string::npos || raw[begin] == '#') continue;
    std::istringstream words(raw.substr(begin));
    ScriptLine line{.number = number};
    words >> line.verb;
    const auto found =
        std::ranges::find_if(scriptVerbs(), [&](const ScriptVerb& verb) { return line.verb == verb.name; });
    if (found == scriptVerbs().end())
      fail(name, number, fmt::format("{}: no such verb; {}", printable(line.verb), chooseFrom(line.verb, verbNames())));
    while (found->endsInText && static_cast<int>(line.words.size()) + 1 < found->most) {
      std::string word;
      if (!(words >> word)) break;
      line.words.push_back(word);
    }
    if (found->endsInText) {
      std::string rest;
      std::getline(words >> std::ws, rest);
      while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.pop_back();
      if (!rest.empty()) line.words.push_back(rest);
    } else {
      for (std::string word; words >> word;) line.words.push_back(word);
    }
    const int count = static_cast<int>(line.words.size());
    if (count < found->least || count > found->most)
      fail(name, number, fmt::format("write: {} {}", found->name, found->takes));
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<ScriptLine> readScript(const std::filesystem::path& path) {
  return parseScript(path.string(), readFile(path, 1 << 20));
}

double scriptNumber(const std::string& name, const ScriptLine& line, size_t word) {
  const std::optional<double> value = parseNumber(line.words[word]);
  if (!value) fail(name, line.number, fmt::format("{}: is not a number", line.words[word]));
  return *value;
}

int scriptCount(const std::string& name, const ScriptLine& line, size_t word, int least, int most) {
  const double value = scriptNumber(name, line, word);
  if (!(value >= least && value <= most) || value != std::floor(value))
    fail(name, line.number, fmt::format("{}: write a whole number, {}..{}", line.words[word], least, most));
  return static_cast<int>(value);
}

size_t scriptChoice(const std::string& name, const ScriptLine& line, size_t word,
                    const std::vector<std::string>& choices) {
  if (line.words.size() <= word) return 0;
  const auto found = std::ranges::find(choices, line.words[word]);
  if (found == choices.end())
    fail(name, line.number, fmt::format("{}: write {}", line.words[word], fmt::join(choices, " or ")));
  return static_cast<size_t>(found - choices.begin());
}

}  // namespace gnomon
