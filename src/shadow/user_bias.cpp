#include "shadow/user_bias.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "gpu/glsl_comments.h"
#include "gpu/glsl_words.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

WorldError lineError(const UserBias& bias, int line, const std::string& what, const std::string& remedy) {
  return WorldError(fmt::format("{}:{}: {}; {}", printable(bias.path), line, what, remedy));
}

Unit parseUnit(const UserBias& bias, int line, const std::string& word) {
  if (word == "metres") return Unit::Metres;
  if (word == "texels") return Unit::Texels;
  if (word == "one") return Unit::One;
  throw lineError(bias, line, fmt::format("'{}' is not a unit", word), "write metres, texels or one");
}

bool isKnobName(const std::string& name) {
  return std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

void readKnob(UserBias& bias, int line, const std::string& text) {
  std::vector<Knob>& knobs = bias.method.knobs;
  std::istringstream words(text);
  std::string name, unit, rest;
  Knob knob{};
  words >> name >> unit >> knob.lower >> knob.upper >> knob.defaultValue;
  if (!words || !(knob.lower <= knob.upper))
    throw lineError(bias, line, "the parameter is not understood",
                    "write //! knob: NAME UNIT LOWER UPPER DEFAULT [scene]");
  if (words >> rest && rest != "scene")
    throw lineError(bias, line, fmt::format("'{}' after the parameter's default", rest), "write scene, or nothing");
  if (!isKnobName(name))
    throw lineError(bias, line, fmt::format("'{}' cannot name a parameter", name),
                    "begin with a letter, and take letters, digits, - and _ only");
  for (const Knob& other : knobs)
    if (knobConstant(other.name) == knobConstant(name))
      throw lineError(bias, line, fmt::format("two parameters are named '{}'", name), "rename one of them");
  if (std::ssize(knobs) == glsl::kMostKnobs)
    throw lineError(bias, line, fmt::format("'{}' is one parameter too many", name),
                    fmt::format("a bias has at most {}", glsl::kMostKnobs));
  knob.unit = parseUnit(bias, line, unit);
  knob.defaultOfSceneScale = rest == "scene";
  knob.name = (bias.knobNames[knobs.size()] = name).c_str();
  knob.sentence = bias.knobSentence.c_str();
  knob.searchUpper = knob.upper;
  knob.searchLower = std::max(knob.lower, 1e-7f * knob.upper);
  knobs.push_back(knob);
}

void readChannels(UserBias& bias, int line, const std::string& text) {
  const std::optional<ChannelSet> set = parseChannels(text);
  if (!set)
    throw lineError(bias, line, fmt::format("'{}' is not a list of channels", text),
                    fmt::format("choose from {}", channelNames()));
  bias.method.channels = *set;
}

std::string knobsGlsl(const std::vector<Knob>& knobs) {
  std::string text = "GNOMON_SHARED_BEGIN\n";
  for (size_t i = 0; i < knobs.size(); ++i) text += fmt::format("const int {} = {};\n", knobConstant(knobs[i].name), i);
  return text + "GNOMON_SHARED_END\n";
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
    else if (key == "channels")
      readChannels(bias, number, value);
    else if (key == "layers")
      throw lineError(
          bias, number, "a bias asks for channels, no longer for layers",
          "for 1 write nothing, for 2 //! channels: depth, second-depth, for back //! channels: back-depth, "
          "and read tap.zBack");
    else if (key == "knob")
      readKnob(bias, number, value);
    else
      throw lineError(bias, number, fmt::format("'{}' is not understood", line),
                      "write //! name:, sentence:, channels: or knob:");
  }
}

// Calls visit(word, where, line) for each "#word" that is no comment's: `where` is the place of the #.
template <typename Visit>
void eachDirective(const std::string& glsl, const Visit& visit) {
  const std::string code = gpu::blankComments(glsl, gpu::CommentBreaks::Blanked);
  bool begins = true;  // nothing but blanks since the line began
  int line = 1;
  for (size_t i = 0; i < code.size(); ++i) {
    const char c = code[i], last = i > 0 ? code[i - 1] : '\0';
    if (begins && c == '#') {
      const size_t word = std::min(code.find_first_not_of(" \t", i + 1), code.size());
      size_t end = word;
      while (end < code.size() && gpu::isWordLetter(code[end])) ++end;
      visit(std::string_view(code).substr(word, end - word), i, line);
    }
    const bool breaks = c == '\r' || (c == '\n' && last != '\r');
    // A line may go on behind a backslash.
    begins = breaks ? last != '\\' : begins && (c == ' ' || c == '\t' || c == '\n');
    line += glsl[i] == '\n' ? 1 : 0;
  }
}

// #line directives as blanks, so that messages tell the file's own lines; those within comments stay.
std::string withoutLineDirectives(std::string glsl) {
  std::vector<size_t> places;
  eachDirective(glsl, [&](std::string_view, size_t where, int) {
    const size_t word = glsl.find_first_not_of(" \t", where + 1);
    if (word == std::string::npos || glsl.compare(word, 4, "line") != 0) return;
    const size_t number = glsl.find_first_not_of(" \t", word + 4);
    if (number != std::string::npos && std::isdigit(static_cast<unsigned char>(glsl[number])) != 0)
      places.push_back(where);
  });
  for (size_t i : places)
    for (; i < glsl.size() && glsl[i] != '\n' && glsl[i] != '\r' && glsl.compare(i, 2, "/*") != 0; ++i) glsl[i] = ' ';
  return glsl;
}

// One that is open at the end, or ends what did not begin, would be told of a file of Gnomon's that comes after.
void checkConditionals(const UserBias& bias) {
  std::vector<std::pair<std::string, int>> open;  // with its line
  eachDirective(bias.source, [&](std::string_view word, size_t, int line) {
    if (word == "if" || word == "ifdef" || word == "ifndef") open.emplace_back(word, line);
    const bool ends = word == "endif" || word == "else" || word == "elif";
    if (ends && open.empty()) throw lineError(bias, line, fmt::format("#{} without #if", word), "remove it");
    if (word == "endif") open.pop_back();
  });
  if (!open.empty())
    throw lineError(bias, open.back().second, fmt::format("#{} has no #endif", open.back().first), "write one");
}

// Members of Tap and Receiver that a text reads, in its order, and the channels that hold them.
class ChannelReads {
 public:
  struct Read {
    std::string text;  // "tap.z2"
    int line;
    ChannelSet anyOf;  // one of these is enough
    ChannelSet first;  // the one to ask for
  };

  explicit ChannelReads(const std::string& glsl) : words_(gpu::wordsOf(glsl)) {
    for (size_t i = 0; i < words_.size(); ++i) {
      findDeclared(i);
      if (is(i, ".") && i > 0 && i + 1 < words_.size()) findRead(i);
    }
  }

  const std::vector<Read>& all() const { return reads_; }

 private:
  bool is(size_t i, const char* text) const { return i < words_.size() && words_[i].text == text; }
  bool isName(size_t i) const { return i < words_.size() && words_[i].isName(); }

  // "Tap a", and b of "Tap a = f(c, d), b". A name has the type of its last declaration so far.
  void findDeclared(size_t i) {
    depth_ += is(i, "(") || is(i, "[") ? 1 : is(i, ")") || is(i, "]") ? -1 : 0;
    if (is(i, ";") || is(i, "{") || depth_ < declaredDepth_) declaredType_.clear();
    if (isName(i) && isName(i + 1) && !is(i, "return") && !is(i, "else")) {
      declaredType_ = words_[i].text;
      declaredDepth_ = depth_;
      types_[words_[i + 1].text] = declaredType_;
    } else if (is(i, ",") && depth_ == declaredDepth_ && !declaredType_.empty() && isName(i + 1) && !isName(i + 2)) {
      types_[words_[i + 1].text] = declaredType_;
    }
  }

  // `i`: of the point.
  void findRead(size_t i) {
    size_t of = i - 1;  // "taps" of "taps[1].z2"
    for (int depth = 0; of > 0; --of) {
      depth += is(of, "]") ? 1 : is(of, "[") ? -1 : 0;
      if (depth == 0 && !is(of, "[")) break;
    }
    const auto type = types_.find(words_[of].text);
    if (type == types_.end()) return;
    Read read{.text = words_[of].text + "." + words_[i + 1].text, .line = words_[i + 1].line, .anyOf = 0, .first = 0};
    if (type->second == "Tap")
      for (const Channel& channel : channels())
        if (is(i + 1, channel.member)) read.anyOf = read.first = channel.bit;
    if (type->second == "Receiver" && is(i + 1, "id")) {
      read.first = glsl::kChannelIds;
      read.anyOf = glsl::kChannelIds | glsl::kChannelSecondIds;  // shaders/shadow/receiver_id.glsl
    }
    if (is(i + 2, "=") && !is(i + 3, "="))
      written_.insert(read.text);  // from here on it holds what the bias put there
    else if (read.anyOf != 0 && !written_.contains(read.text))
      reads_.push_back(read);
  }

  std::vector<gpu::Word> words_;
  std::map<std::string, std::string> types_;  // of variables, by name
  std::set<std::string> written_;
  std::vector<Read> reads_;
  std::string declaredType_;
  int depth_ = 0, declaredDepth_ = 0;
};

// What the map does not hold is as in an empty texel, and the bias would be scored as another.
void checkChannels(const UserBias& bias) {
  const ChannelReads reads(bias.source);
  ChannelSet needed = bias.method.channels;
  const ChannelReads::Read* missing = nullptr;
  for (const ChannelReads::Read& read : reads.all()) {
    if ((bias.method.channels & read.anyOf) != 0) continue;
    needed |= read.first;
    if (missing == nullptr) missing = &read;
  }
  if (missing != nullptr)
    throw lineError(bias, missing->line, "reads " + missing->text,
                    "write //! channels: " + channelNames(completed(needed)));
}

}  // namespace

UserBiasKey::UserBiasKey(const UserBias* of) : bias(of), number(of != nullptr ? of->number : 0) {}

std::string knobConstant(const std::string& knob) {
  std::string constant = "kUser";
  bool begins = true;
  for (const char c : knob) {
    if (c != '-' && c != '_') constant += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '-' || c == '_';
  }
  return constant;
}

namespace {

// The file, and behind it none of its macros: what is included after it has names of its own.
std::string withMacrosOfItsOwn(const std::string& source) {
  std::string undefined;
  std::set<std::string> names;
  const std::vector<gpu::Word> words = gpu::wordsOf(source);
  for (size_t i = 2; i < words.size(); ++i)
    if (words[i - 2].text == "#" && words[i - 1].text == "define" && words[i].isName() &&
        names.insert(words[i].text).second)
      undefined += fmt::format("#undef {}\n", words[i].text);
  return undefined.empty() ? source : source + "\n\n" + undefined;  // a backslash may stand at its end
}

}  // namespace

gpu::ShaderSource shaderWith(const char* path, const UserBias* bias) {
  if (bias == nullptr) return {path, {}};
  return {path,
          {{std::string(kUserBiasFile), withoutLineDirectives(withMacrosOfItsOwn(bias->source))},
           {std::string(kUserKnobsFile), bias->knobsGlsl}}};
}

// The compiler knows the file by the name it takes the place of.
std::string inUsersWords(std::string message, const UserBias& bias) {
  const std::string path = printable(bias.path);
  for (size_t at = 0; (at = message.find(kUserBiasFile, at)) != std::string::npos; at += path.size())
    message.replace(at, kUserBiasFile.size(), path);
  return message;
}

std::unique_ptr<const UserBias> loadUserBias(const std::filesystem::path& path) {
  constexpr uint64_t kMostBytes = 64 << 10;
  return readUserBias(path, readFile(path, kMostBytes));
}

std::unique_ptr<const UserBias> readUserBias(const std::filesystem::path& path, const std::string& source) {
  static std::atomic<uint64_t> read{0};
  auto bias = std::make_unique<UserBias>();
  bias->number = ++read;
  bias->path = path.string();
  bias->source = source;
  bias->name = path.stem().string();
  bias->sentence = "Your own bias: " + bias->path;
  bias->knobSentence = fmt::format("a knob of {}", bias->path);
  if (source.starts_with("\xef\xbb\xbf"))
    throw lineError(*bias, 1, "the file begins with a byte-order mark", "save it as UTF-8 without one");
  // The compiler would take it for the end.
  if (const size_t zero = source.find('\0'); zero != std::string::npos)
    throw lineError(*bias, 1 + static_cast<int>(std::count(source.begin(), source.begin() + zero, '\n')), "a zero byte",
                    "write the file as text");
  checkConditionals(*bias);
  readHeader(*bias);
  checkChannels(*bias);
  bias->knobsGlsl = knobsGlsl(bias->method.knobs);
  for (const BiasMethod& method : biasMethods())
    if (bias->name == method.name)
      throw fileError(bias->path, fmt::format("'{}' is the name of a built-in bias", bias->name),
                      "rename the file, or write //! name: another");
  if (bias->name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") !=
          std::string::npos ||
      bias->name.starts_with('.'))
    throw fileError(bias->path, fmt::format("'{}' cannot be part of a file name", bias->name),
                    "use letters, digits, -, _ and . only");
  bias->method.id = glsl::kBiasUser;
  bias->method.name = bias->name.c_str();
  bias->method.sentence = bias->sentence.c_str();
  bias->method.user = bias.get();
  return bias;
}

}  // namespace gnomon
