#include "lab/export/refuse_user_code.h"

#include "base/error.h"
#include "gpu/glsl_comments.h"
#include "lab/export/preprocess_glsl.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

// A name, a number or a character of anything else but blanks.
struct Word {
  std::string text;
  int line = 1;

  bool isName() const { return lengthOfWord(text) > 0; }
};

std::vector<Word> wordsOf(const std::string& glsl) {
  const std::string code = gpu::blankComments(glsl);
  std::vector<Word> words;
  int line = 1;
  for (size_t i = 0; i < code.size();) {
    const size_t length = std::max<size_t>(1, lengthOfWord(std::string_view(code).substr(i)));
    if (std::isspace(static_cast<unsigned char>(code[i])) == 0)
      words.push_back({.text = code.substr(i, length), .line = line});
    line += code[i] == '\n' ? 1 : 0;
    i += length;
  }
  return words;
}

// The line of the first word of which `isIt(i)`, where there is one.
template <typename IsIt>
std::optional<int> lineWhere(const std::vector<Word>& words, const IsIt& isIt) {
  for (size_t i = 0; i < words.size(); ++i)
    if (isIt(i)) return words[i].line;
  return std::nullopt;
}

// The line on which a word stands; 1 where it does not, as it does of a macro's making.
int lineOf(const std::vector<Word>& words, const std::string& text) {
  return lineWhere(words, [&](size_t i) { return words[i].text == text; }).value_or(1);
}

// The line on which a name is declared: behind its type, where one is given; else behind any type or a comma. `count`:
// how many times before.
int lineOfDeclared(const std::vector<Word>& words, const std::string& type, const std::string& name, int count = 0) {
  const auto before = [&](size_t i) { return i > 0 ? words[i - 1].text : std::string(";"); };
  const auto isBehind = [&](size_t i) { return words[i].text == name && before(i) == type; };
  if (const auto line = lineWhere(words, isBehind); line && !type.empty()) return *line;
  std::string first;  // of a statement: the type of what is behind its commas
  const auto isBehindComma = [&](size_t i) {
    for (const char* end : {";", "{", "}", "const"})
      if (before(i) == end) first = words[i].text;
    return words[i].text == name && before(i) == "," && first == type;
  };
  if (const auto line = lineWhere(words, isBehindComma)) return *line;
  const auto isBehindAny = [&](size_t i) {
    if (i == 0 || words[i].text != name) return false;
    const std::string last = before(i);
    const bool isType = words[i - 1].isName() && last != "return" && last != "define" && last != "else";
    return (last == "," || isType) && count-- == 0;
  };
  return lineWhere(words, isBehindAny).value_or(1);
}

class Refusal {
 public:
  Refusal(const Program& program, const UserBias& user, Language language)
      : program_(program), user_(user), language_(language), words_(wordsOf(user.source)) {}

  // Names that are folded wherever they stand, by name and not by what they are; a second function of a name; and names
  // that are another's once they have export's prefix.
  void ofNames(const Known& known, const std::set<std::string>& taken) {
    gatherNames(known);
    std::map<std::string, std::string> printed;  // and what is printed so
    for (const std::string& name : taken) printed[name] = "a name of export's own";
    for (const Decl& decl : program_.decls)
      if (decl.file != kUserBiasFile) printed[prefixedName(decl)] = fmt::format("Gnomon's {}", decl.name);
    for (size_t i = 0; i < program_.decls.size(); ++i) {
      const Decl& decl = program_.decls[i];
      if (decl.file != kUserBiasFile) continue;
      const std::string type = decl.kind == Decl::Kind::Struct ? "struct" : decl.type;
      if (decl.kind != Decl::Kind::Constant) {
        refuseSecond(i);
        checkName("", decl.name, type);
      }
      const auto [at, isNew] = printed.emplace(prefixedName(decl), decl.name);
      if (!isNew)
        failAt(lineOfDeclared(words_, type, decl.name),
               fmt::format("{} is exported as {}, as is {}; rename it", decl.name, at->first, at->second));
      for (const Param& param : decl.params) checkLocal(param.type, param.name);
      std::vector<Stmt> body = decl.body;
      eachStmt(body, [&](const Stmt& stmt) {
        for (const Declarator& declared : stmt.names) checkLocal(stmt.type, declared.name);
      });
    }
  }

  // Knobs become constants: each is read by its own, and nothing else of them is left.
  void ofKnobs() const {
    eachUserExpr([&](const Expr& e) {
      if (e.kind == Expr::Kind::Index && isKnobs(e.kids[0]) && !isKnobPlace(e.kids[1]))
        failKnob([&](size_t i) { return textAt(i) == "knobs" && !isPlaceAt(i + 2); },
                 "a knob is read by the constant that has its name");
      const bool writes = e.isAssignment() || e.text == "++" || e.text == "--";
      if (writes && !e.kids.empty() && readsKnobs(e.kids[0]))
        failKnob([&](size_t i) { return textAt(i) == "knobs" && isWrittenAt(i); }, "a knob is a constant");
      const Decl* called = e.kind == Expr::Kind::Call ? program_.find(e.text) : nullptr;
      for (size_t i = 0; called != nullptr && i < std::min(e.kids.size(), called->params.size()); ++i)
        if (!called->params[i].qualifier.empty() && readsKnobs(e.kids[i]))
          failKnob([&](size_t k) { return textAt(k) == "knobs"; }, "a knob is a constant");
    });
    // Other than as the place of a knob, its constant is a number that is gone.
    for (const Decl& decl : program_.decls) {
      if (decl.file != kUserKnobsFile || decl.kind != Decl::Kind::Constant) continue;
      size_t all = 0, places = 0;
      eachUserExpr([&](const Expr& e) {
        all += e.isAtom(decl.name) ? 1 : 0;
        places += e.kind == Expr::Kind::Index && isKnobs(e.kids[0]) && e.kids[1].isAtom(decl.name) ? 1 : 0;
      });
      if (all != places)
        failKnob([&](size_t i) { return textAt(i) == decl.name && (i < 2 || textAt(i - 2) != "knobs"); },
                 fmt::format("{} is a knob's place, and no number", decl.name));
    }
  }

  void ofBuiltIns() {
    eachUserExpr([&](const Expr& e) {
      if (e.kind == Expr::Kind::Atom && e.text.starts_with("gl_"))
        failAt(lineOf(words_, e.text),
               fmt::format("{} is the calling shader's, which export does not know; write it without", e.text));
    });
  }

  void ofGlslEs() {
    const auto fail = [&](const std::string& word) {
      failAt(lineOf(words_, word),
             fmt::format("GLSL ES 3.00 has no {}; write it without, or export --lang glsl", word));
    };
    eachUserType([&](const std::string& type) {
      if (isDoubleType(type)) fail(type);
    });
    eachUserExpr([&](const Expr& e) {
      if (isDouble(e)) fail(e.text);
      const bool isMissing = isDoubleType(e.text) || missingInEs().contains(e.text);
      if (e.kind == Expr::Kind::Call && isMissing && program_.find(e.text) == nullptr) fail(e.text);
    });
  }

  // What has no translation to HLSL and Metal yet, where it would be another language's words, or mean something else.
  void ofUntranslated();

 private:
  [[noreturn]] void failAt(int line, const std::string& what) const {
    throw WorldError(fmt::format("{}:{}: {}", user_.path, line, what));
  }
  // `isIt(i)`: of the words, the one that is told.
  template <typename IsIt>
  [[noreturn]] void failKnob(const IsIt& isIt, const std::string& what) const {
    const std::string knob = user_.knobNames[0].empty() ? "width" : user_.knobNames[0];
    failAt(lineWhere(words_, isIt).value_or(lineOf(words_, "knobs")),
           fmt::format("{}; write params.knobs[{}], read only", what, knobConstant(knob)));
  }

  std::string textAt(size_t i) const { return i < words_.size() ? words_[i].text : ""; }
  // "kUserWidth]"
  bool isPlaceAt(size_t i) const { return isKnobPlace(atom(textAt(i))) && textAt(i + 1) == "]"; }
  // Of "params.knobs[kUserWidth] = ", "+=", "++", or "++" in front; `i`: of "knobs".
  bool isWrittenAt(size_t i) const {
    const std::string one = textAt(i + 4), two = textAt(i + 5);
    if (i >= 4 && textAt(i - 3) == textAt(i - 4) && (textAt(i - 3) == "+" || textAt(i - 3) == "-")) return true;
    if (one == "=") return two != "=";
    return (one == "+" || one == "-" || one == "*" || one == "/") && (two == "=" || (two == one && one != "/"));
  }

  void gatherNames(const Known& known) {
    folded_ = known.unread;
    const auto add = [&](const std::string& path) {
      const size_t dot = path.find('.');
      (dot == std::string::npos ? folded_ : roots_).insert(path.substr(0, dot));
    };
    for (const auto& [path, value] : known.values) add(path);
    for (const auto& [path, replacement] : known.replacements) {
      add(path);
      if (replacement.find('.') == std::string::npos) folded_.insert(replacement);
    }
    for (const Decl& decl : program_.decls) {
      if (decl.kind == Decl::Kind::Constant) folded_.insert(decl.name);
      if (decl.file == kUserBiasFile) continue;
      for (const Param& param : decl.params) own_.emplace(param.type, param.name);
    }
  }

  void refuseSecond(size_t i) const {
    const Decl& decl = program_.decls[i];
    for (size_t k = 0; k < program_.decls.size(); ++k)
      if (decl.hasBody && k != i && program_.decls[k].name == decl.name &&
          (k < i || program_.decls[k].file != kUserBiasFile))
        failAt(lineOfDeclared(words_, "", decl.name, k < i && program_.decls[k].file == kUserBiasFile ? 1 : 0),
               fmt::format("{} is defined twice; exported code has no overloads, rename one", decl.name));
  }

  // `type`: of a variable, which may be Gnomon's own by that type and name; `written`: the word in front.
  void checkName(const std::string& type, const std::string& name, const std::string& written) const {
    if (folded_.contains(name) || (roots_.contains(name) && !own_.contains({type, name})))
      failAt(lineOfDeclared(words_, written, name),
             fmt::format("'{}' is a name that export takes for its own (docs/shared_glsl.md); rename it", name));
  }

  void checkLocal(const std::string& type, const std::string& name) const {
    checkName(type, name, type);
    const bool isPrefixed = name.starts_with("gnomon") || name.starts_with("Gnomon") || name.starts_with("kGnomon");
    if (isPrefixed || (name == "textures" && language_ == Language::Msl))
      failAt(lineOfDeclared(words_, type, name),
             fmt::format("'{}' may be another's name in exported code; rename it", name));
  }

  template <typename Visit>
  void eachUserExpr(const Visit& visit) const {
    for (Decl decl : program_.decls)
      if (decl.file == kUserBiasFile) eachExpr(decl, visit);
  }

  // Of variables, parameters, members, and what functions return.
  template <typename Visit>
  void eachUserType(const Visit& visit) const {
    for (Decl decl : program_.decls) {
      if (decl.file != kUserBiasFile) continue;
      if (decl.kind != Decl::Kind::Struct) visit(decl.type);
      for (const Param& param : decl.params) visit(param.type);
      eachStmt(decl.members, [&](const Stmt& stmt) { visit(stmt.type); });
      eachStmt(decl.body, [&](const Stmt& stmt) { visit(stmt.type); });
    }
  }

  static bool isKnobs(const Expr& e) { return e.kind == Expr::Kind::Member && e.text == "knobs"; }

  bool isKnobPlace(const Expr& e) const {
    const Decl* decl = e.kind == Expr::Kind::Atom ? program_.find(e.text) : nullptr;
    return decl != nullptr && decl->file == kUserKnobsFile;
  }

  static bool readsKnobs(Expr e) {
    bool reads = false;
    eachExpr(e, [&](const Expr& part) { reads = reads || isKnobs(part); });
    return reads;
  }

  static bool isDouble(const Expr& e) {
    const bool isNumber = std::isdigit(static_cast<unsigned char>(e.text[0])) != 0 || e.text[0] == '.';
    return e.kind == Expr::Kind::Atom && isNumber && (e.text.ends_with("lf") || e.text.ends_with("LF"));
  }

  static bool isDoubleType(const std::string& type) {
    return type == "double" || type.starts_with("dvec") || type.starts_with("dmat");
  }

  static const std::set<std::string>& missingInEs();

  const Program& program_;
  const UserBias& user_;
  Language language_;
  std::vector<Word> words_;                            // of the user's file
  std::set<std::string> folded_, roots_;               // "reach"; "tap" of "tap.z1"
  std::set<std::pair<std::string, std::string>> own_;  // types and names of Gnomon's
};

const std::set<std::string>& Refusal::missingInEs() {
  static const std::set<std::string> names = {"bitCount",
                                              "bitfieldExtract",
                                              "bitfieldInsert",
                                              "bitfieldReverse",
                                              "dFdxCoarse",
                                              "dFdxFine",
                                              "dFdyCoarse",
                                              "dFdyFine",
                                              "findMSB",
                                              "fma",
                                              "frexp",
                                              "fwidthCoarse",
                                              "fwidthFine",
                                              "imulExtended",
                                              "ldexp",
                                              "packDouble2x32",
                                              "packSnorm4x8",
                                              "packUnorm4x8",
                                              "uaddCarry",
                                              "umulExtended",
                                              "unpackDouble2x32",
                                              "unpackSnorm4x8",
                                              "unpackUnorm4x8",
                                              "usubBorrow"};
  return names;
}

// GLSL's functions that have the same name and meaning in HLSL and Metal, or a name there that print_code.cpp knows.
const std::set<std::string>& translatedFunctions() {
  static const std::set<std::string> names = {
      "abs",        "acos",  "all",         "any",       "asin",  "atan",           "ceil",    "clamp",
      "cos",        "cross", "distance",    "dot",       "exp",   "exp2",           "findLSB", "floatBitsToUint",
      "floor",      "fract", "inversesqrt", "isinf",     "isnan", "length",         "log",     "log2",
      "max",        "min",   "mix",         "normalize", "pow",   "reflect",        "sign",    "sin",
      "smoothstep", "sqrt",  "step",        "tan",       "trunc", "uintBitsToFloat"};
  return names;
}

bool isSwizzleOf(const Expr& e, size_t count) {
  return e.kind == Expr::Kind::Member && e.text.size() >= count &&
         e.text.find_first_not_of("xyzw") == std::string::npos;
}

void Refusal::ofUntranslated() {
  const auto fail = [&](const std::string& word, const std::string& what) {
    failAt(lineOf(words_, word), fmt::format("{} is not translated to {}; write it without, or export --lang glsl",
                                             what, language_ == Language::Hlsl ? "HLSL" : "Metal"));
  };
  std::set<std::string> types = {"void", "bool",  "int",   "uint",  "float", "vec2", "vec3",
                                 "vec4", "ivec2", "ivec3", "uvec2", "uvec3", "uvec4"};
  std::set<std::string> functions = translatedFunctions();
  for (const Decl& decl : program_.decls) (decl.kind == Decl::Kind::Struct ? types : functions).insert(decl.name);
  eachUserType([&](const std::string& type) {
    if (!type.empty() && !types.contains(type)) fail(type, type);
  });
  eachUserExpr([&](const Expr& e) {
    if (isDouble(e)) fail(e.text, e.text);
    if (e.kind != Expr::Kind::Call) return;
    if (!types.contains(e.text) && !functions.contains(e.text)) fail(e.text, e.text);
    if (e.text == "atan" && e.kids.size() != 1) fail(e.text, "atan of two numbers");
    const size_t count = e.text.starts_with("vec") && e.text.size() == 4 ? static_cast<size_t>(e.text[3] - '0') : 0;
    if (count == 0 || e.kids.size() != 1) return;
    // One number for all components, or a longer vector: they are not told apart here.
    const Expr& only = e.kids[0];
    const bool isNumber = only.kind == Expr::Kind::Atom && std::isdigit(static_cast<unsigned char>(only.text[0])) != 0;
    if (!isNumber && !isSwizzleOf(only, count)) fail(e.text, fmt::format("{} of one value that is no number", e.text));
  });
}

}  // namespace

void refuseUserCode(const Program& program, const UserBias& user, const Known& known, Language language,
                    const std::set<std::string>& taken) {
  Refusal refusal(program, user, language);
  refusal.ofNames(known, taken);
  refusal.ofKnobs();
  refusal.ofBuiltIns();
  if (language == Language::GlslEs) refusal.ofGlslEs();
  if (language == Language::Hlsl || language == Language::Msl) refusal.ofUntranslated();
}

void refuseLeftParams(const Program& program, const UserBias& user) {
  for (const Decl& decl : program.decls)
    for (const Param& param : decl.params)
      if (decl.file == kUserBiasFile && param.type == "BiasParams")
        throw WorldError(
            fmt::format("{}:{}: {} uses its BiasParams for more than to read knobs; read "
                        "{}.knobs[...] there, or pass on what it needs of them",
                        user.path, lineOfDeclared(wordsOf(user.source), decl.type, decl.name), decl.name, param.name));
}

}  // namespace gnomon::code
