#include "lab/export/refuse_user_code.h"

#include "base/error.h"
#include "gpu/glsl_words.h"
#include "lab/export/expressions.h"
#include "lab/export/untranslated.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

// The line of the first word of which `isIt(i)`, where there is one.
template <typename IsIt>
std::optional<int> lineWhere(const std::vector<gpu::Word>& words, const IsIt& isIt) {
  for (size_t i = 0; i < words.size(); ++i)
    if (isIt(i)) return words[i].line;
  return std::nullopt;
}

// The line on which a word stands; 1 where it does not, as it does of a macro's making.
int lineOf(const std::vector<gpu::Word>& words, const std::string& text) {
  return lineWhere(words, [&](size_t i) { return words[i].text == text; }).value_or(1);
}

// The line on which a name is declared: behind its type, where one is given; else behind any type or a comma. `count`:
// how many times before.
int lineOfDeclared(const std::vector<gpu::Word>& words, const std::string& type, const std::string& name,
                   int count = 0) {
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
      : program_(program), user_(user), language_(language), words_(gpu::wordsOf(user.source)) {}

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
      std::map<std::string, std::string> variables;  // as they are printed
      for (const Param& param : decl.params) checkLocal(param.type, param.name, variables);
      eachStmt(decl.body, [&](const Stmt& stmt) {
        for (const Declarator& declared : stmt.names) checkLocal(stmt.type, declared.name, variables);
      });
      for (const Stmt& member : decl.members)
        for (const Declarator& declared : member.names) checkPrinted(member.type, declared.name, variables);
    }
  }

  // A user's function beside a built-in one of its name, which is still called: by Gnomon's code, by the function
  // itself, or with another number of arguments.
  void ofOverloads() const {
    for (const Decl& decl : program_.decls)
      eachExprAndItsVariables(decl, [&](const Expr& e, const Variables&) {
        const Decl* called = e.kind == Expr::Kind::Call && e.text != "userLit" ? program_.find(e.text) : nullptr;
        if (called == nullptr || called->file != kUserBiasFile || called->kind != Decl::Kind::Function) return;
        if (decl.file == kUserBiasFile && decl.name != e.text && e.kids.size() == called->params.size()) return;
        failAt(lineOfDeclared(words_, called->type, called->name),
               fmt::format("{} is a built-in function, too, which is called beside it; exported code has no overloads, "
                           "rename it",
                           e.text));
      });
  }

  // What simplify() replaces wherever it stands, or lets go of.
  void ofEffects(const Known& known) const {
    eachUserExpr([&](const Expr& e) {
      const bool writes = e.isAssignment() || e.text == "++" || e.text == "--";
      if (writes && !e.kids.empty() && e.kids[0].kind == Expr::Kind::Member) {
        const std::string path = e.kids[0].kids[0].text + "." + e.kids[0].text;
        if (e.kids[0].kids[0].kind == Expr::Kind::Atom &&
            (known.replacements.contains(path) || known.values.contains(path)))
          failAt(e.line, fmt::format("{} is a constant in exported code; copy it to a variable", path));
      }
      const Decl* called = e.kind == Expr::Kind::Call ? program_.find(e.text) : nullptr;
      if (called == nullptr || called->file == kUserBiasFile) return;
      for (const Expr& argument : e.kids)
        if (writesVariable(argument, program_))
          failAt(e.line,
                 fmt::format("an argument of {} writes to a variable, and may go with what {} does not need of it "
                             "here; write it on a line of its own",
                             e.text, e.text));
    });
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
    eachUserExpr([&](const Expr& e, const Variables& variables) {
      if (e.kind != Expr::Kind::Atom || isNumber(e) || e.text == "true" || e.text == "false") return;
      const bool isVariable = variables.typeOf(e.text) != nullptr;
      if (isVariable || folded_.contains(e.text) || program_.find(e.text) != nullptr) return;
      failAt(e.line, fmt::format("{} is the calling shader's, which export does not know; write it without", e.text));
    });
  }

  // A declaration of a case is printed in braces of the case's.
  void ofCases() const {
    for (const Decl& decl : program_.decls)
      if (decl.file == kUserBiasFile)
        eachStmt(decl.body, [&](const Stmt& stmt) {
          for (size_t i = 0; i < stmt.cases.size(); ++i)
            for (const Stmt& declaration : stmt.cases[i].body)
              for (const Declarator& declared : declaration.names) checkLaterCases(stmt, i, declared.name);
        });
  }

  void ofUntranslated() const {
    if (const auto found = firstUntranslated(program_, language_))
      failAt(found->line > 0 ? found->line : lineOf(words_, found->word), found->message);
  }

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

  // `printed`: the names of one function's variables, or of a structure's members, by what they are printed as.
  void checkPrinted(const std::string& type, const std::string& name,
                    std::map<std::string, std::string>& printed) const {
    const auto [at, isNew] = printed.emplace(variableNameIn(language_, name), name);
    if (!isNew && at->second != name)
      failAt(lineOfDeclared(words_, type, name),
             fmt::format("{} is exported as {}, as is {}; rename one", name, at->first, at->second));
  }

  void checkLocal(const std::string& type, const std::string& name, std::map<std::string, std::string>& printed) const {
    checkName(type, name, type);
    checkPrinted(type, name, printed);
    const Decl* same = program_.find(name);
    if (same != nullptr && same->kind == Decl::Kind::Struct)
      failAt(lineOfDeclared(words_, type, name), fmt::format("{} is a structure's name, too; rename it", name));
    const bool isPrefixed = name.starts_with("gnomon") || name.starts_with("Gnomon") || name.starts_with("kGnomon");
    if (isPrefixed || (name == "textures" && language_ == Language::Msl))
      failAt(lineOfDeclared(words_, type, name),
             fmt::format("'{}' may be another's name in exported code; rename it", name));
  }

  void checkLaterCases(const Stmt& of, size_t i, const std::string& name) const {
    for (++i; i < of.cases.size(); ++i)
      if (const Expr* found = firstRead(of.cases[i].body, name).read)
        failAt(found->line, fmt::format("{} is of another case; declare it before the switch", name));
  }

  struct Reading {
    const Expr* read = nullptr;
    bool isDeclared = false;  // first
  };
  static const Expr* firstRead(const std::optional<Expr>& e, const std::string& name) {
    return e ? firstRead(*e, name) : nullptr;
  }
  static const Expr* firstRead(const Expr& e, const std::string& name) {
    if (e.isAtom(name)) return &e;
    for (const Expr& kid : e.kids)
      if (const Expr* found = firstRead(kid, name)) return found;
    return nullptr;
  }
  // Where a name is read that the statements do not declare themselves.
  static Reading firstRead(const std::vector<Stmt>& body, const std::string& name) {
    for (const Stmt& stmt : body) {
      for (const Declarator& declared : stmt.names) {
        if (const Expr* found = firstRead(declared.value, name)) return {.read = found};
        if (declared.name == name) return {.isDeclared = true};
      }
      const bool isLoop = stmt.kind == Stmt::Kind::For;
      if (isLoop) {
        const Reading first = firstRead(stmt.other, name);
        if (first.read != nullptr) return first;
        if (first.isDeclared) continue;
      }
      if (const Expr* found = firstRead(stmt.expr, name)) return {.read = found};
      if (const Expr* found = firstRead(stmt.step, name)) return {.read = found};
      for (const std::vector<Stmt>* within : {&stmt.body, &stmt.other})
        if (const Expr* found = firstRead(*within, name).read) return {.read = found};
      for (const Stmt::Case& one : stmt.cases)
        if (const Expr* found = firstRead(one.body, name).read) return {.read = found};
    }
    return {};
  }

  void eachUserExpr(const std::function<void(const Expr&)>& visit) const {
    eachUserExpr([&](const Expr& e, const Variables&) { visit(e); });
  }
  void eachUserExpr(const std::function<void(const Expr&, const Variables&)>& visit) const {
    for (const Decl& decl : program_.decls)
      if (decl.file == kUserBiasFile) eachExprAndItsVariables(decl, visit);
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

  const Program& program_;
  const UserBias& user_;
  Language language_;
  std::vector<gpu::Word> words_;                       // of the user's file
  std::set<std::string> folded_, roots_;               // "reach"; "tap" of "tap.z1"
  std::set<std::pair<std::string, std::string>> own_;  // types and names of Gnomon's
};

}  // namespace

void refuseUserCode(const Program& program, const UserBias& user, const Known& known, Language language,
                    const std::set<std::string>& taken) {
  Refusal refusal(program, user, language);
  refusal.ofNames(known, taken);
  refusal.ofOverloads();
  refusal.ofEffects(known);
  refusal.ofKnobs();
  refusal.ofBuiltIns();
  refusal.ofCases();
  refusal.ofUntranslated();
}

void refuseLeftParams(const Program& program, const UserBias& user) {
  for (const Decl& decl : program.decls)
    for (const Param& param : decl.params)
      if (decl.file == kUserBiasFile && param.type == "BiasParams")
        throw WorldError(fmt::format(
            "{}:{}: {} uses its BiasParams for more than to read knobs; read "
            "{}.knobs[...] there, or pass on what it needs of them",
            user.path, lineOfDeclared(gpu::wordsOf(user.source), decl.type, decl.name), decl.name, param.name));
}

}  // namespace gnomon::code
