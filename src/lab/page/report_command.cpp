#include "lab/page/report_command.h"

#include "shadow/bias.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Words of a shell's line; quotes stay, since the words go back into a line.
std::vector<std::string> wordsOf(const std::string& line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ' ' && !quoted) {
      if (!words.back().empty()) words.emplace_back();
      continue;
    }
    words.back() += c;
    if (c == '\\' && !quoted && i + 1 < line.size())
      words.back() += line[++i];
    else if (c == '\'')
      quoted = !quoted;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// A word that a shell takes for nothing but itself.
std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-+.,:/%@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

const BiasMethod* methodNamed(const std::string& name) {
  const auto found = std::ranges::find_if(biasMethods(), [&](const BiasMethod& m) { return name == m.name; });
  return found == biasMethods().end() ? nullptr : &*found;
}

bool isKnobFlag(std::string_view flag) {
  for (const BiasMethod& method : biasMethods())
    for (const Knob& knob : method.knobs)
      if (flag == fmt::format("--{}-{}", method.name, knob.name)) return true;
  return false;
}

// Flags with a value that the row replaces or that only say where results go.
constexpr std::array kDropped = {"--maps",       "--biases", "--filters", "--map-size", "--map-texels", "--cull",
                                 "--epsilon-at", "-o",       "--out",     "--json",     "--fail-if"};

std::string keptPart(const std::string& command, bool dropsLight) {
  std::string kept;
  bool dropsNext = false;
  for (const std::string& word : wordsOf(command)) {
    if (std::exchange(dropsNext, false)) continue;
    if (word == "--tune" || word == "--quiet") continue;
    if (word.starts_with("-o") && word.size() > 2) continue;  // -oDIR
    const std::string flag = word.substr(0, word.find('='));
    if (std::ranges::find(kDropped, flag) != kDropped.end() || isKnobFlag(flag) || (dropsLight && flag == "--light")) {
      dropsNext = flag.size() == word.size();
      continue;
    }
    kept += (kept.empty() ? "" : " ") + word;
  }
  return kept;
}

std::string knobFlag(const Row& row, const std::string& knob) {
  const BiasMethod* method = methodNamed(row.bias);
  const bool shares = method != nullptr && method->sharesKnobsWith != nullptr;
  return fmt::format("--{}-{}", shares ? method->sharesKnobsWith : row.bias, knob);
}

}  // namespace

std::string rowCommand(const std::string& command, const Row& row) {
  if (!command.starts_with("gnomon compare ")) return command;
  std::string line =
      keptPart(command, !row.light.empty()) + fmt::format(" --maps {} --biases {}", quoted(row.map), quoted(row.bias));
  if (!row.light.empty()) line += " --light " + quoted(row.light);
  if (row.filter != "none") line += " --filters " + quoted(row.filter);
  line += fmt::format(" --map-size {}", row.mapSide);
  for (const Param& param : row.params) {
    if (row.isKnob(param) && isKnobFlag(knobFlag(row, param.name)))
      line += fmt::format(" {} {}", knobFlag(row, param.name), paramText(param));
    else if (param.name == "cull")
      line += " --cull " + quoted(paramText(param));
    else if (param.name == "epsilon_at")
      line += " --epsilon-at " + quoted(paramText(param));
  }
  return line;
}

}  // namespace gnomon
