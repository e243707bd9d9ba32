#include "lab/export/preprocess_glsl.h"

#include "base/error.h"
#include "gpu/glsl_words.h"
#include "lab/export/macro_expansion.h"
#include "shadow/user_bias.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

// "// text" to " text", so that pictures keep their columns.
std::string commentText(std::string_view line) {
  line.remove_prefix(std::min<size_t>(line.find("//") + 2, line.size()));
  return std::string(line.substr(0, line.find_last_not_of(" \t\r") + 1));
}

size_t lengthOfOperator(std::string_view rest) {
  for (const char* three : {"<<=", ">>="})
    if (rest.starts_with(three)) return 3;
  for (const char* two :
       {"==", "!=", "<=", ">=", "&&", "||", "<<", ">>", "++", "--", "+=", "-=", "*=", "/=", "|=", "&=", "^="})
    if (rest.starts_with(two)) return 2;
  return 1;
}

struct Condition {
  bool active = true;
  bool hasElse = false;
  std::string word, file;
  int line = 0;
};

// Line breaks as they are on Linux.
std::string withPlainBreaks(const std::string& text) {
  std::string plain;
  plain.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    plain += text[i] == '\r' ? '\n' : text[i];
  }
  return plain;
}

class Preprocessor {
 public:
  explicit Preprocessor(const ReadOptions& options) {
    for (const char* name : {"GNOMON_FN", "GNOMON_SHARED_BEGIN", "GNOMON_SHARED_END"}) macros_.set(name, {});
    setMacro("GNOMON_OUT", {"T"}, "out T");
    setMacro("GNOMON_INOUT", {"T"}, "inout T");
    setMacro("GNOMON_GLSL_ONLY", {"T"}, "T");
    setMacro("GNOMON_CPP_ONLY", {"T"}, "");
    setMacro("GNOMON_PUBLIC_ONLY", {"T"}, options.publicMembers ? "T" : "");
    setMacro("GNOMON_MEMBER_ARRAY", {"object", "array"}, "object.array");
    macros_.set("GNOMON_PRECISE", {.body = tokensOf("precise")});
    kept_ = {"GNOMON_FN",
             "GNOMON_SHARED_BEGIN",
             "GNOMON_SHARED_END",
             "GNOMON_OUT",
             "GNOMON_INOUT",
             "GNOMON_GLSL_ONLY",
             "GNOMON_CPP_ONLY",
             "GNOMON_PUBLIC_ONLY",
             "GNOMON_MEMBER_ARRAY",
             "GNOMON_PRECISE",
             "atan2"};
    // As glslang has them of our shaders (gpu/shader_compiler.cpp), so that what is exported is what is measured.
    macros_.set("VULKAN", {.body = tokensOf("100")});
    macros_.set("GL_core_profile", {.body = tokensOf("1")});
    macros_.set("__VERSION__", {.body = tokensOf("460")});
    for (const std::string& name : options.defined) macros_.set(name, {});
    for (const auto& [name, text] : options.aliases) macros_.set(name, {.body = tokensOf(text)});
    for (const auto& [name, text] : options.aliases) kept_.insert(name);
  }

  Tokens run(const std::string& given) {
    const std::string text = withPlainBreaks(given);
    std::string line;  // without comments in /* */, its continuations joined
    int begin = line_, now = line_;
    const auto end = [&] {
      line_ = begin;
      readLine(line);
      now += line_ - begin;  // where it was #line
      line.clear();
    };
    for (size_t i = 0; i < text.size();) {
      const std::string_view rest = std::string_view(text).substr(i);
      if (rest.starts_with("\\\n")) {
        ++now;
        i += 2;
      } else if (rest.starts_with("//")) {
        while (i < text.size() && text[i] != '\n') {
          const bool goesOn = text.compare(i, 2, "\\\n") == 0;
          if (!goesOn) line += text[i];
          now += goesOn ? 1 : 0;
          i += goesOn ? 2 : 1;
        }
      } else if (rest.starts_with("/*")) {
        const size_t close = rest.find("*/", 2);
        line_ = now;
        if (close == std::string_view::npos) fail(line_, "a comment does not end", "close it with */");
        const size_t first = line.find_first_not_of(" \t");
        const auto breaks = static_cast<int>(std::count(rest.begin(), rest.begin() + close, '\n'));
        // A directive goes on behind it; other code may as well be two lines.
        if (breaks > 0 && first != std::string::npos && line[first] != '#') end();
        line += ' ';
        now += breaks;
        if (line.find_first_not_of(" \t") == std::string::npos) begin = now;
        i += close + 2;
      } else if (text[i] == '\n') {
        end();
        begin = ++now;
        ++i;
      } else {
        line += text[i++];
      }
    }
    line_ = begin;
    if (!line.empty()) readLine(line);
    if (!conditions_.empty()) failOpen(conditions_.back());
    return {.tokens = macros_.takeExpanded(), .heads = std::move(heads_)};
  }

 private:
  [[noreturn]] void fail(int line, const std::string& what, const std::string& remedy) const {
    throw WorldError(fmt::format("{}:{}: {}; {}", file_, line, what, remedy));
  }
  [[noreturn]] static void failOpen(const Condition& one) {
    throw WorldError(fmt::format("{}:{}: #{} has no #endif; write one", one.file, one.line, one.word));
  }
  void setMacro(const char* name, std::vector<std::string> params, const std::string& body) {
    macros_.set(name, {.hasParams = true, .params = std::move(params), .body = tokensOf(body)});
  }

  std::vector<Token> tokensOf(const std::string& text) {
    std::vector<Token> tokens;
    tokenize(text, tokens);
    return tokens;
  }

  // Returns the comment behind the last one.
  std::string tokenize(std::string_view line, std::vector<Token>& tokens) {
    for (size_t i = 0; i < line.size();) {
      if (std::isspace(static_cast<unsigned char>(line[i])) != 0) {
        ++i;
        continue;
      }
      if (line.substr(i).starts_with("//")) return commentText(line.substr(i));
      size_t length = gpu::lengthOfWord(line.substr(i));
      if (length == 0) length = lengthOfOperator(line.substr(i));
      tokens.push_back({.text = std::string(line.substr(i, length)), .file = file_, .line = line_});
      i += length;
    }
    return {};
  }

  bool isActive() const {
    return std::ranges::all_of(conditions_, [](const Condition& one) { return one.active; });
  }

  void readLine(const std::string& line) {
    const size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) {
      endHead();
      pending_.clear();
      return;
    }
    if (line[first] == '#') {
      endHead();
      pending_.clear();
      readDirective(line.substr(first + 1));
      return;
    }
    if (!isActive()) return;
    std::vector<Token> tokens;
    const std::string comment = tokenize(line, tokens);
    if (tokens.empty()) {
      (inHead_ ? head_ : pending_).push_back(comment);
      return;
    }
    endHead();
    tokens.back().after = comment;
    if (tokens.front().text == "GNOMON_FN") tokens.erase(tokens.begin());
    if (tokens.empty()) return;
    tokens.front().before = std::move(pending_);
    pending_.clear();
    macros_.read(tokens);
  }

  void endHead() {
    if (inHead_ && !head_.empty()) heads_.emplace_back(file_, std::move(head_));
    head_.clear();
    inHead_ = false;
  }

  // The name that a directive is about.
  std::string nameIn(const std::vector<Token>& tokens) const {
    if (tokens.size() < 2 || !tokens[1].isName())
      fail(line_, fmt::format("#{} without a name", tokens[0].text), "write the macro's name behind it");
    return tokens[1].text;
  }

  static bool isConditional(const std::string& what) {
    for (const char* one : {"if", "ifdef", "ifndef", "elif", "else", "endif"})
      if (what == one) return true;
    return false;
  }

  // As glslang answers, which replaces __VERSION__ and __LINE__ but does not take them for defined. Of the names that
  // it has of its own, extensions and such, not all are known here.
  bool isDefined(const std::string& name) const {
    if (name == "__VERSION__" || name == "GL_SPIRV" || name == "__cplusplus") return false;
    const bool defined = macros_.contains(name);
    if (!defined && file_ == kUserBiasFile && name.starts_with("GL_"))
      fail(line_, fmt::format("whether {} is defined is the compiler's to say, and not known here", name),
           "write the file without asking");
    return defined;
  }

  void readCondition(const std::vector<Token>& tokens) {
    const std::string& what = tokens[0].text;
    if (what == "ifdef" || what == "ifndef") {
      const bool active = !isActive() || isDefined(nameIn(tokens)) == (what == "ifdef");
      conditions_.push_back({.active = active, .word = what, .file = file_, .line = line_});
      return;
    }
    if (what == "if") {  // where nothing is read, what it asks is not asked
      if (isActive()) failDirective(what);
      conditions_.push_back({.word = what, .file = file_, .line = line_});
      return;
    }
    // A user's file ends what it begins, and no more: readUserBias() has seen to it.
    if (conditions_.empty()) fail(line_, fmt::format("#{} without #ifdef or #ifndef", what), "remove it");
    Condition& last = conditions_.back();
    if (what == "endif") {
      conditions_.pop_back();
      return;
    }
    if (last.hasElse) fail(line_, fmt::format("#{} after #else", what), "remove one");
    last.hasElse = what == "else";
    const bool isSkipped = last.word == "if";
    if (what == "elif" && !isSkipped) failDirective(what);
    if (!isSkipped) last.active = !last.active;
  }

  [[noreturn]] void failDirective(const std::string& what) const {
    fail(line_, fmt::format("#{} is not understood", what),
         "export reads the dialect of docs/shared_glsl.md, which has #ifdef and #ifndef");
  }

  void readDirective(const std::string& text) {
    std::vector<Token> tokens;
    tokenize(text, tokens);
    if (tokens.empty()) return;
    const std::string& what = tokens[0].text;
    if (what == "line") {
      readLineDirective(text, tokens);
    } else if (isConditional(what)) {
      readCondition(tokens);
    } else if (!isActive()) {
      return;
    } else if (what == "define") {
      define(text, tokens);
    } else if (what == "undef") {
      if (const std::string name = nameIn(tokens); !kept_.contains(name)) macros_.remove(name);
    } else if (what != "version" && what != "extension") {  // C++ has #include
      failDirective(what);
    }
  }

  // Of gpu::expandShader: a user's own are gone (shaderWith()), but for what is no number.
  void readLineDirective(const std::string& text, const std::vector<Token>& tokens) {
    const size_t quote = text.find('"');
    const bool isNumber = tokens.size() > 1 && tokens[1].text.size() < 9 &&
                          std::ranges::all_of(tokens[1].text, [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!isNumber || quote == std::string::npos) {
      if (!isActive()) return;
      fail(line_, "#line is not understood", "remove it: lines are counted as the file has them");
    }
    line_ = std::stoi(tokens[1].text) - 1;
    file_ = text.substr(quote + 1, text.rfind('"') - quote - 1);
    inHead_ = line_ == 0;
  }

  void define(const std::string& text, const std::vector<Token>& tokens) {
    const std::string name = nameIn(tokens);
    if (kept_.contains(name)) return;
    Macro macro;
    size_t at = 2;
    // Behind "define", which may hold the name, too.
    const size_t place = text.find(name, text.find("define") + 6) + name.size();
    if (place < text.size() && text[place] == '(') {
      macro.hasParams = true;
      for (at = 3;; ++at) {
        if (at >= tokens.size())
          fail(line_, fmt::format("the parameters of macro {} do not end", name), "close the parenthesis");
        if (tokens[at].text == ")") break;
        if (tokens[at].text != ",") macro.params.push_back(tokens[at].text);
      }
      ++at;
    }
    macro.body.assign(tokens.begin() + static_cast<std::ptrdiff_t>(at), tokens.end());
    macros_.set(name, std::move(macro));
  }

  MacroExpansion macros_;
  std::set<std::string> kept_;  // that no directive replaces
  std::vector<Condition> conditions_;
  std::vector<std::string> pending_, head_;
  std::vector<std::pair<std::string, std::vector<std::string>>> heads_;
  bool inHead_ = false;
  std::string file_;
  int line_ = 1;
};

}  // namespace

Tokens preprocessGlsl(const std::string& text, const ReadOptions& options) {
  return Preprocessor(options).run(text);
}

}  // namespace gnomon::code
