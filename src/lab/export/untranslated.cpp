#include "lab/export/untranslated.h"

#include "lab/export/expressions.h"
#include "shadow/user_bias.h"

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
    eachUserExpr([&](const Expr& e, const Variables& variables) {
      if (isDouble(e)) tell(e.line, e.text);
      checkComparison(e, variables);
      if (language_ == Language::Hlsl) checkForHlsl(e, variables);
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
    const std::string type = typeOf(only, variables, program_), name = shortly(only);
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
      const std::string type = typeOf(kid, variables, program_);
      const Decl* decl = program_.find(type);
      const char* what = isVector(type)                                        ? "vectors"
                         : isMatrix(type)                                      ? "matrices"
                         : type.ends_with("[]")                                ? "arrays"
                         : decl != nullptr && decl->kind == Decl::Kind::Struct ? "structures"
                                                                               : nullptr;
      if (what != nullptr) tell(e.line, fmt::format("{} of {}", e.text, what), "compare them number by number");
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
    if (e.kind != Expr::Kind::Binary || (e.text != "*" && e.text != "*=")) return;
    const std::string left = typeOf(e.kids[0], variables, program_), right = typeOf(e.kids[1], variables, program_);
    if ((isMatrix(left) && !isScalar(right)) || (isMatrix(right) && !isScalar(left)))
      tell(e.line, "the product of a matrix", "write transform(m, v)");
  }

  const Program& program_;
  Language language_;
  std::optional<Untranslated> found_;
};

}  // namespace

std::optional<Untranslated> firstUntranslated(const Program& program, Language language) {
  Search search(program, language);
  if (language == Language::GlslEs) search.forGlslEs();
  if (language == Language::Hlsl || language == Language::Msl) search.forHlslAndMetal();
  return search.found();
}

}  // namespace gnomon::code
