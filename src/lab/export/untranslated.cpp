#include "lab/export/untranslated.h"

#include "lab/export/expressions.h"
#include "shadow/user_bias.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

// Functions of later versions than GLSL ES 3.00.
const std::set<std::string>& missingInEs() {
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

bool isDoubleType(const std::string& type) {
  return type == "double" || type.starts_with("dvec") || type.starts_with("dmat");
}

bool isDouble(const Expr& e) {
  return e.kind == Expr::Kind::Atom && isNumber(e) && (e.text.ends_with("lf") || e.text.ends_with("LF"));
}

// Of built-in functions: those that take whole numbers, too, and those of which each argument has a type of its own.
bool takesWholeNumbers(const std::string& function) {
  static const std::set<std::string> names = {"abs", "clamp", "max", "min", "sign"};
  return names.contains(function);
}
bool takesAnything(const std::string& function) {
  static const std::set<std::string> names = {"all", "any", "findLSB", "floatBitsToUint", "uintBitsToFloat"};
  return names.contains(function);
}

bool isWhole(const std::string& type) {
  return type == "int" || type == "uint" || type.starts_with("ivec") || type.starts_with("uvec");
}
bool isFloats(const std::string& type) {
  return type == "float" || (isVector(type) && type.starts_with("vec"));
}

// "s.a[]" of s.a[i]; empty of what is no variable.
std::string pathOf(const Expr& e) {
  if (e.kind == Expr::Kind::Atom) return isNumber(e) ? "" : e.text;
  if (e.kind == Expr::Kind::Paren) return pathOf(e.kids[0]);
  if (e.kind == Expr::Kind::Member) return pathOf(e.kids[0]) + "." + e.text;
  return e.kind == Expr::Kind::Index ? pathOf(e.kids[0]) + "[]" : "";
}

// Of paths: the same, or one within the other.
bool overlap(const std::string& a, const std::string& b) {
  const auto holds = [](const std::string& of, const std::string& part) {
    return part.starts_with(of) && (part.size() == of.size() || part[of.size()] == '.' || part[of.size()] == '[');
  };
  return !a.empty() && !b.empty() && (holds(a, b) || holds(b, a));
}

bool isSwizzleOf(const Expr& e, size_t count) {
  return e.kind == Expr::Kind::Member && e.text.size() >= count &&
         e.text.find_first_not_of("xyzw") == std::string::npos;
}

// "tap.z1"; "x" of what is more than a name.
std::string shortly(const Expr& e) {
  if (e.kind == Expr::Kind::Atom && !isNumber(e)) return e.text;
  if (e.kind != Expr::Kind::Member) return "x";
  const std::string of = shortly(e.kids[0]);
  return of == "x" ? of : of + "." + e.text;
}

// "x, x, x"
std::string repeated(const std::string& text, int count) {
  std::string all = text;
  for (int i = 1; i < count; ++i) all += ", " + text;
  return all;
}

class Search {
 public:
  Search(const Program& program, Language language) : program_(program), language_(language) {}

  const std::optional<Untranslated>& found() const { return found_; }

  void forGlslEs() {
    eachUserType([&](const std::string& type) {
      if (isDoubleType(type)) tellMissing(0, type);
    });
    eachUserExpr([&](const Expr& e, const Variables&) {
      if (isDouble(e)) tellMissing(e.line, e.text);
      const bool isMissing = isDoubleType(e.text) || missingInEs().contains(e.text);
      if (e.kind == Expr::Kind::Call && isMissing && program_.find(e.text) == nullptr) tellMissing(e.line, e.text);
    });
  }

  void forHlslAndMetal() {
    std::set<std::string> types = {"void", "bool",  "int",   "uint",  "float", "vec2", "vec3",
                                   "vec4", "ivec2", "ivec3", "uvec2", "uvec3", "uvec4"};
    std::set<std::string> functions = translatedFunctions();
    for (const Decl& decl : program_.decls) (decl.kind == Decl::Kind::Struct ? types : functions).insert(decl.name);
    eachUserType([&](const std::string& type) {
      if (!type.empty() && !types.contains(type)) tell(0, type);
    });
    checkDeclarations();
    eachUserExpr([&](const Expr& e, const Variables& variables) {
      if (isDouble(e)) tell(e.line, e.text);
      checkComparison(e, variables);
      checkConstructor(e);
      if (language_ == Language::Hlsl) checkForHlsl(e, variables);
      if (language_ == Language::Msl) checkForMetal(e, variables);
      if (e.kind != Expr::Kind::Call) return;
      if (!types.contains(e.text) && !functions.contains(e.text)) tell(e.line, e.text);
      if (e.text == "atan" && e.kids.size() != 1) tell(e.line, "atan of two numbers");
      checkVector(e, variables);
    });
  }

 private:
  void tellMissing(int line, const std::string& word) {
    add(line, word, fmt::format("GLSL ES 3.00 has no {}; write it without, or export --lang glsl", word));
  }
  void tell(int line, const std::string& what, const std::string& remedy = "write it without") {
    add(line, what,
        fmt::format("{} is not translated to {}; {}, or export --lang glsl", what,
                    language_ == Language::Hlsl ? "HLSL" : "Metal", remedy));
  }
  void add(int line, const std::string& word, const std::string& message) {
    if (!found_) found_ = {.line = line, .word = word, .message = message};
  }

  // Each expression's once: what is around it asks for it, too.
  std::string typeOf(const Expr& e, const Variables& variables) {
    return code::typeOf(e, variables, program_, &types_);
  }

  // Of variables, parameters, members, and what functions return.
  template <typename Visit>
  void eachUserType(const Visit& visit) const {
    for (const Decl& decl : program_.decls) {
      if (decl.file != kUserBiasFile) continue;
      if (decl.kind != Decl::Kind::Struct) visit(decl.type);
      for (const Param& param : decl.params) visit(param.type);
      eachStmt(decl.members, [&](const Stmt& stmt) { visit(stmt.type); });
      eachStmt(decl.body, [&](const Stmt& stmt) { visit(stmt.type); });
    }
  }

  void eachUserExpr(const std::function<void(const Expr&, const Variables&)>& visit) const {
    for (const Decl& decl : program_.decls)
      if (decl.file == kUserBiasFile) eachExprAndItsVariables(decl, visit);
  }

  // A vector of one value: a number for all components, or a vector. HLSL has no constructor for the first, and the
  // second is written as a swizzle, which keeps whole numbers whole.
  void checkVector(const Expr& e, const Variables& variables) {
    const int count = componentCount(e.text);
    if (count == 0 || e.kids.size() != 1 || isNumber(e.kids[0])) return;
    const Expr& only = e.kids[0];
    const std::string type = typeOf(only, variables), name = shortly(only);
    const std::string spread = fmt::format("{}({})", e.text, repeated(name, count));
    const std::string swizzle = name + "." + std::string("xyzw").substr(0, static_cast<size_t>(count));
    const auto fail = [&](const std::string& of, const std::string& remedy) {
      tell(e.line, fmt::format("{}({}) of {}", e.text, name, of), "write " + remedy);
    };
    if (!e.text.starts_with("vec")) {
      if (isScalar(type) && language_ == Language::Hlsl) fail("one number", spread);
      return;
    }
    if (isScalar(type)) fail("one number", spread);
    if (isVector(type) && !type.starts_with("vec"))
      fail("whole numbers", fmt::format("{}(float({}.x), ...)", e.text, name));
    if (isSwizzleOf(only, static_cast<size_t>(count))) return;
    if (isVector(type)) fail("a vector", swizzle);
    fail("one value", fmt::format("{} of a number, {} of a longer vector", spread, swizzle));
  }

  // Vectors compare to vectors of bools in HLSL and Metal, and nothing else compares at all.
  void checkComparison(const Expr& e, const Variables& variables) {
    if (e.kind != Expr::Kind::Binary || (e.text != "==" && e.text != "!=")) return;
    for (const Expr& kid : e.kids) {
      const std::string type = typeOf(kid, variables);
      const Decl* decl = program_.find(type);
      const char* what = isVector(type)                                        ? "vectors"
                         : isMatrix(type)                                      ? "matrices"
                         : type.ends_with("[]")                                ? "arrays"
                         : decl != nullptr && decl->kind == Decl::Kind::Struct ? "structures"
                                                                               : nullptr;
      if (what != nullptr) tell(e.line, fmt::format("{} of {}", e.text, what), "compare them number by number");
    }
  }

  // C++ takes a variable's name for its own from where it stands, GLSL from behind its value.
  void checkDeclarations() {
    for (const Decl& decl : program_.decls)
      if (decl.file == kUserBiasFile)
        eachStmt(decl.body, [&](const Stmt& stmt) {
          for (const Declarator& declared : stmt.names)
            if (declared.value) checkInitializer(stmt.type, declared.name, *declared.value);
        });
  }

  void checkInitializer(const std::string& type, const std::string& name, const Expr& value) {
    if (value.kind == Expr::Kind::Call && value.text == type) initializers_.insert(&value);
    checkOwnName(name, value);
  }

  void checkOwnName(const std::string& name, const Expr& e) {
    if (e.isAtom(name)) tell(e.line, fmt::format("another {0} in the value that it begins with", name), "rename one");
    const bool isBuiltIn = e.kind == Expr::Kind::Call && e.text == name && program_.find(name) == nullptr;
    if (isBuiltIn && nameIn(language_, name) == variableNameIn(language_, name))
      tell(e.line, fmt::format("a variable {0} beside the function {0}", name), "rename it");
    for (const Expr& kid : e.kids) checkOwnName(name, kid);
  }

  // HLSL and Metal have none of structures; what a variable begins with is written in braces.
  void checkConstructor(const Expr& e) {
    const Decl* decl = e.kind == Expr::Kind::Call ? program_.find(e.text) : nullptr;
    if (decl != nullptr && decl->kind == Decl::Kind::Struct && !initializers_.contains(&e))
      tell(e.line, fmt::format("{}(...) but as what a declaration begins with", e.text),
           fmt::format("declare a variable: {} name = {}(...);", e.text, e.text));
  }

  // Its out arguments are references, and its functions have a form for floats and one for whole numbers.
  void checkForMetal(const Expr& e, const Variables& variables) {
    if (e.kind != Expr::Kind::Call) return;
    if (const Decl* called = program_.find(e.text)) {
      checkReferences(e, *called, variables);
    } else if (translatedFunctions().contains(e.text) && !takesAnything(e.text)) {
      bool hasFloats = false, hasWhole = false;
      for (const Expr& kid : e.kids) {
        const std::string type = typeOf(kid, variables);
        hasFloats = hasFloats || isFloats(type);
        hasWhole = hasWhole || isWhole(type);
      }
      if (hasWhole && (hasFloats || !takesWholeNumbers(e.text)))
        tell(e.line, fmt::format("{} of {}whole numbers", e.text, hasFloats ? "floats and " : ""),
             "write 0.0f for 0, float(i) for i");
    }
  }

  void checkReferences(const Expr& e, const Decl& called, const Variables& variables) {
    std::vector<std::string> paths;
    for (size_t i = 0; i < std::min(e.kids.size(), called.params.size()); ++i) {
      if (called.params[i].qualifier.empty()) continue;
      const Expr& argument = e.kids[i];
      const bool isPart = argument.kind == Expr::Kind::Member || argument.kind == Expr::Kind::Index;
      if (isPart && isVector(typeOf(argument.kids[0], variables)))
        tell(e.line, fmt::format("a component as the out argument {} of {}", called.params[i].name, e.text),
             "give it a variable");
      const std::string path = pathOf(argument);
      for (const std::string& other : paths)
        if (overlap(path, other))
          tell(e.line, fmt::format("one variable twice as an out argument of {}", e.text), "give it two");
      paths.push_back(path);
    }
  }

  // HLSL evaluates all of `&&`, `||` and `?:`, whatever is on the left. Its `*` multiplies matrices number by number.
  void checkForHlsl(const Expr& e, const Variables& variables) {
    if (e.kind == Expr::Kind::Ternary || e.text == "&&" || e.text == "||") {
      for (size_t i = 1; i < e.kids.size(); ++i)
        if (writesVariable(e.kids[i], program_))
          tell(e.line,
               e.kind == Expr::Kind::Ternary
                   ? "a value of ? that writes to a variable (HLSL evaluates both)"
                   : fmt::format("a right side of {} that writes to a variable (HLSL always evaluates it)", e.text),
               "write it with if");
    }
    if (e.kind == Expr::Kind::Call && e.text == "sign" && program_.find(e.text) == nullptr && e.kids.size() == 1 &&
        isWhole(typeOf(e.kids[0], variables)))
      tell(e.line, "sign of whole numbers", "write clamp(i, -1, 1)");
    if (e.kind != Expr::Kind::Binary || (e.text != "*" && e.text != "*=")) return;
    const std::string left = typeOf(e.kids[0], variables), right = typeOf(e.kids[1], variables);
    if ((isMatrix(left) && !isScalar(right)) || (isMatrix(right) && !isScalar(left)))
      tell(e.line, "the product of a matrix", "write transform(m, v)");
  }

  const Program& program_;
  Language language_;
  std::optional<Untranslated> found_;
  ExprTypes types_;
  std::set<const Expr*> initializers_;  // structures' constructors
};

}  // namespace

std::optional<Untranslated> firstUntranslated(const Program& program, Language language) {
  Search search(program, language);
  if (language == Language::GlslEs) search.forGlslEs();
  if (language == Language::Hlsl || language == Language::Msl) search.forHlslAndMetal();
  return search.found();
}

}  // namespace gnomon::code
