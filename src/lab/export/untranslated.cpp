#include "lab/export/untranslated.h"

#include "lab/export/expressions.h"
#include "shadow/user_bias.h"

#include <algorithm>
#include <cstdlib>
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
  return type == "double" || (type.starts_with('d') && (isVector(type) || isMatrix(type)));
}

bool isDouble(const Expr& e) {
  return e.kind == Expr::Kind::Atom && isNumber(e) && (e.text.ends_with("lf") || e.text.ends_with("LF"));
}

// Of Metal's functions: those that take whole numbers, too; those that take vectors only; and those of which each
// argument has a type of its own.
bool takesWholeNumbers(const std::string& function) {
  static const std::set<std::string> names = {"abs", "clamp", "max", "min"};
  return names.contains(function);
}
bool takesVectorsOnly(const std::string& function) {
  static const std::set<std::string> names = {"distance", "dot", "length", "normalize", "reflect"};
  return names.contains(function);
}
bool takesAnything(const std::string& function) {
  static const std::set<std::string> names = {"all", "any", "findLSB", "floatBitsToUint", "uintBitsToFloat"};
  return names.contains(function);
}

bool isWhole(const std::string& type) {
  return type == "int" || type == "uint" || type.starts_with("ivec") || type.starts_with("uvec");
}
bool isBools(const std::string& type) {
  return type == "bool" || (isVector(type) && type.starts_with("bvec"));
}
bool isFloats(const std::string& type) {
  return type == "float" || (isVector(type) && type.starts_with("vec"));
}

bool endsInBreakOrReturn(const std::vector<Stmt>& body) {
  if (body.empty()) return false;
  const Stmt& last = body.back();
  if (last.kind == Stmt::Kind::Block) return endsInBreakOrReturn(last.body);
  return last.kind == Stmt::Kind::Break || last.kind == Stmt::Kind::Return;
}

const Expr& bare(const Expr& e) {
  return e.kind == Expr::Kind::Paren ? bare(e.kids[0]) : e;
}

using Path = std::vector<std::string>;
constexpr const char* kAnyElement = "[]";

// "s", ".a", "[1]" of s.a[1], and kAnyElement of s.a[i]; empty of what is no variable.
Path pathOf(const Expr& e) {
  if (e.kind == Expr::Kind::Paren) return pathOf(e.kids[0]);
  if (e.kind == Expr::Kind::Atom) return isNumber(e) ? Path{} : Path{e.text};
  if (e.kind != Expr::Kind::Member && e.kind != Expr::Kind::Index) return {};
  Path path = pathOf(e.kids[0]);
  if (e.kind == Expr::Kind::Member) {
    path.push_back("." + e.text);
  } else {
    const Expr& index = bare(e.kids[1]);
    const bool isKnown = index.kind == Expr::Kind::Atom && isNumber(index);
    path.push_back(isKnown ? fmt::format("[{}]", std::strtoull(index.text.c_str(), nullptr, 0)) : kAnyElement);
  }
  return path;
}

// Of variables: the same, or one within the other.
enum class Overlap { None, Perhaps, Sure };

Overlap overlapOf(const Path& a, const Path& b) {
  if (a.empty() || b.empty()) return Overlap::None;
  Overlap all = Overlap::Sure;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] == kAnyElement || b[i] == kAnyElement)
      all = Overlap::Perhaps;
    else if (a[i] != b[i])
      return Overlap::None;
  }
  return all;
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
    eachUserExpr([&](const Expr& e, const Variables& variables) {
      if (isDouble(e)) tellMissing(e.line, e.text);
      if (callsBuiltIn(e, "mix") && isWhole(typeOf(e, variables))) tellMissing(e.line, "mix of whole numbers");
      if (callsBuiltIn(e, "findLSB") && typeOf(e.kids[0], variables) != "uint")
        tellMissing(e.line, "findLSB but of one uint");
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
    if (language_ == Language::Hlsl) checkCases();
    eachUserExpr([&](const Expr& e, const Variables& variables) {
      if (isDouble(e)) tell(e.line, e.text);
      checkNumber(e, variables);
      checkLetters(e, variables);
      checkComparison(e, variables);
      checkConstructor(e);
      if (language_ == Language::Hlsl) checkForHlsl(e, variables);
      if (language_ == Language::Msl) checkForMetal(e, variables);
      if (e.kind != Expr::Kind::Call) return;
      if (!types.contains(e.text) && !functions.contains(e.text)) tell(e.line, e.text);
      if (callsBuiltIn(e, "atan") && e.kids.size() != 1) tell(e.line, "atan of two numbers");
      if (callsBuiltIn(e, "mix") && e.kids.size() == 3 && isBools(typeOf(e.kids[2], variables)))
        tell(e.line, "mix by true or false", "write it with ?");  // by 0 or 1 elsewhere, where NaN stays NaN
      checkComponents(e, variables);
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
  bool callsBuiltIn(const Expr& e, const std::string& name) const {
    return e.kind == Expr::Kind::Call && e.text == name && program_.find(name) == nullptr;
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

  // Which are negative in GLSL, and of a longer or an unsigned type elsewhere.
  void checkNumber(const Expr& e, const Variables& variables) {
    if (e.kind == Expr::Kind::Atom && isNumber(e) && typeOf(e, variables) == "int" &&
        std::strtoull(e.text.c_str(), nullptr, 0) > 0x7fffffffu)
      tell(e.line, fmt::format("{}, of more than 31 bits,", e.text), fmt::format("write int({}u)", e.text));
  }

  void checkLetters(const Expr& e, const Variables& variables) {
    if (e.kind == Expr::Kind::Member && e.text.find_first_not_of("stpq") == std::string::npos &&
        isVector(typeOf(e.kids[0], variables)))
      tell(e.line, fmt::format(".{} of a vector", e.text), "write it with the letters xyzw");
  }

  // Constructors of numbers and vectors elsewhere take no longer ones.
  void checkComponents(const Expr& e, const Variables& variables) {
    if (!isVector(e.text) && !isScalar(e.text)) return;
    const int count = std::max(componentCount(e.text), 1);
    int given = 0;
    for (const Expr& kid : e.kids) given += std::max(componentCount(typeOf(kid, variables)), 1);
    const bool isSwizzle = e.text.starts_with("vec") && e.kids.size() == 1;  // which checkVector() is about
    if (given > count && !isSwizzle)
      tell(e.line, fmt::format("{} of {} numbers", e.text, given), "write .x, .xy or .xyz behind the last");
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
    for (const Decl& decl : program_.decls) {
      if (decl.file != kUserBiasFile) continue;
      std::set<std::string> variables;
      for (const Param& param : decl.params) variables.insert(param.name);
      eachStmt(decl.body, [&](const Stmt& stmt) {
        for (const Declarator& declared : stmt.names) {
          variables.insert(declared.name);
          if (declared.value) checkInitializer(stmt.type, declared, *declared.value);
        }
      });
      checkCalled(decl, variables);
    }
  }

  void checkInitializer(const std::string& type, const Declarator& declared, const Expr& value) {
    if (value.kind == Expr::Kind::Call && value.text == type) initializers_.insert(&value);
    if (isWhole(type)) wholeValues_.insert(&bare(value));
    checkOwnName(declared.name, value);
    if (declared.count && language_ == Language::Msl) tellArray(value.line);
  }

  // A function that has another name elsewhere is printed as what is called so in the same declaration; and Metal's
  // constants call none.
  void checkCalled(const Decl& decl, const std::set<std::string>& variables) {
    const bool isConstant = decl.kind == Decl::Kind::Constant && language_ == Language::Msl;
    eachExprAndItsVariables(decl, [&](const Expr& e, const Variables&) {
      if (e.kind != Expr::Kind::Call || program_.find(e.text) != nullptr) return;
      if (variables.contains(e.text) && nameIn(language_, e.text) != e.text)
        tell(e.line, fmt::format("a variable {0} beside the function {0}", e.text), "rename it");
      if (isConstant && !isVector(e.text) && !isScalar(e.text))
        tell(e.line, fmt::format("{} in the value of the constant {}", e.text, decl.name), "write the number");
    });
  }

  // FXC takes none that goes on in the next.
  void checkCases() {
    for (const Decl& decl : program_.decls) {
      if (decl.file != kUserBiasFile) continue;
      eachStmt(decl.body, [&](const Stmt& stmt) {
        for (size_t i = 0; i + 1 < stmt.cases.size(); ++i)
          if (const Stmt::Case& one = stmt.cases[i]; !one.body.empty() && !endsInBreakOrReturn(one.body))
            tell(one.line, "a case that does not end in break or return",
                 "end it with break, or repeat the statements");
      });
    }
  }

  // Which C++ has no values of.
  void tellArray(int line) { tell(line, "an array assigned as a whole", "assign its elements"); }

  void checkOwnName(const std::string& name, const Expr& e) {
    if (e.isAtom(name)) tell(e.line, fmt::format("another {0} in the value that it begins with", name), "rename one");
    if (callsBuiltIn(e, name) && nameIn(language_, name) == variableNameIn(language_, name))
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
    if (e.isAssignment() && typeOf(e.kids[0], variables).ends_with("[]")) tellArray(e.line);
    if (e.kind != Expr::Kind::Call) return;
    if (const Decl* called = program_.find(e.text)) {
      checkReferences(e, *called, variables);
      if (called->kind == Decl::Kind::Struct) checkMembers(e, *called, variables);
    } else if (translatedFunctions().contains(e.text)) {
      checkArguments(e, variables);
    }
  }

  void checkArguments(const Expr& e, const Variables& variables) {
    if (takesAnything(e.text)) return checkBits(e, variables);
    bool hasFloats = false, hasInts = false, hasUints = false;
    for (const Expr& kid : e.kids) {
      const std::string type = typeOf(kid, variables);
      hasFloats = hasFloats || isFloats(type);
      hasUints = hasUints || (isWhole(type) && type.starts_with('u'));
      hasInts = hasInts || (isWhole(type) && type.starts_with('i'));
      if (takesVectorsOnly(e.text) && isScalar(type))
        tell(e.line, fmt::format("{} of a number", e.text), "write it with * and abs");
    }
    if (hasInts && hasUints && !hasFloats)
      tell(e.line, fmt::format("{} of int and uint", e.text), "write 0u for 0, uint(i) for i");
    if ((hasInts || hasUints) && (hasFloats || !takesWholeNumbers(e.text)))
      tell(e.line, fmt::format("{} of {}whole numbers", e.text, hasFloats ? "floats and " : ""),
           "write 0.0f for 0, float(i) for i");
  }

  // In braces no number becomes one of another type, but where it is written out.
  void checkMembers(const Expr& e, const Decl& made, const Variables& variables) {
    size_t i = 0;
    for (const Stmt& member : made.members)
      for (size_t k = 0; k < member.names.size() && i < e.kids.size(); ++k, ++i)
        if (const std::string type = typeOf(e.kids[i], variables);
            isWhole(type) && type != member.type && !isNumber(e.kids[i]))
          tell(e.line, fmt::format("{} as the {} {} of {}", type, member.type, member.names[k].name, e.text),
               fmt::format("write {}(...)", member.type));
  }

  // These take one number; and bits that are a member are those of three (print_code.cpp).
  void checkBits(const Expr& e, const Variables& variables) {
    if (e.text == "all" || e.text == "any") return;
    const std::string type = typeOf(e.kids[0], variables);
    if (e.text == "uintBitsToFloat" && e.kids[0].kind == Expr::Kind::Member) {
      if (type != "uvec3") tell(e.line, fmt::format("{} of a member", e.text), "give it a variable");
    } else if (isVector(type)) {
      tell(e.line, fmt::format("{} of a vector", e.text), "write it number by number");
    }
  }

  void checkReferences(const Expr& e, const Decl& called, const Variables& variables) {
    std::vector<Path> paths;
    for (size_t i = 0; i < std::min(e.kids.size(), called.params.size()); ++i) {
      if (called.params[i].qualifier.empty()) continue;
      const Expr& argument = bare(e.kids[i]);
      const std::string type = typeOf(argument, variables);
      if (!type.empty() && type != called.params[i].type)
        tell(e.line,
             fmt::format("another type than {} as the out argument {} of {}", called.params[i].type,
                         called.params[i].name, e.text),
             "give it a variable");
      const bool isPart = argument.kind == Expr::Kind::Member || argument.kind == Expr::Kind::Index;
      if (isPart && isVector(typeOf(argument.kids[0], variables)))
        tell(e.line, fmt::format("a component as the out argument {} of {}", called.params[i].name, e.text),
             "give it a variable");
      const Path path = pathOf(argument);
      for (const Path& other : paths)
        if (const Overlap overlap = overlapOf(path, other); overlap != Overlap::None)
          tell(e.line,
               fmt::format("{} twice as an out argument of {}",
                           overlap == Overlap::Sure ? "one variable" : "what may be one element", e.text),
               "give it two variables");
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
    const Decl* made = e.kind == Expr::Kind::Ternary ? program_.find(typeOf(e, variables)) : nullptr;
    if (made != nullptr && made->kind == Decl::Kind::Struct) tell(e.line, "? of structures", "write it with if");
    checkLowestBit(e, variables);
    if (callsBuiltIn(e, "sign") && e.kids.size() == 1 && isWhole(typeOf(e.kids[0], variables)))
      tell(e.line, "sign of whole numbers", "write clamp(i, -1, 1)");
    if (e.kind != Expr::Kind::Binary || (e.text != "*" && e.text != "*=")) return;
    const std::string left = typeOf(e.kids[0], variables), right = typeOf(e.kids[1], variables);
    if ((isMatrix(left) && !isScalar(right)) || (isMatrix(right) && !isScalar(left)))
      tell(e.line, "the product of a matrix", "write transform(m, v)");
  }

  // HLSL's is unsigned: none is 4294967295 but where it becomes an int.
  void checkLowestBit(const Expr& e, const Variables& variables) {
    if (e.kind == Expr::Kind::Call && isWhole(e.text) && e.kids.size() == 1) wholeValues_.insert(&bare(e.kids[0]));
    if (e.isAssignment() && isWhole(typeOf(e.kids[0], variables))) wholeValues_.insert(&bare(e.kids[1]));
    if (callsBuiltIn(e, "findLSB") && !wholeValues_.contains(&e))
      tell(e.line, "findLSB but as the value of an int", "write int(findLSB(...))");
  }

  const Program& program_;
  Language language_;
  std::optional<Untranslated> found_;
  ExprTypes types_;
  std::set<const Expr*> initializers_;  // structures' constructors
  std::set<const Expr*> wholeValues_;   // what becomes an int or a uint
};

}  // namespace

std::optional<Untranslated> firstUntranslated(const Program& program, Language language) {
  Search search(program, language);
  if (language == Language::GlslEs) search.forGlslEs();
  if (language == Language::Hlsl || language == Language::Msl) search.forHlslAndMetal();
  return search.found();
}

}  // namespace gnomon::code
