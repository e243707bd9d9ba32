#include "lab/export/print_code.h"

#include "lab/export/expressions.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

constexpr size_t kPageWidth = 120;

using Names = std::map<std::string, std::string>;

const Names& hlslNames() {
  static const Names names = {{"vec2", "float2"},
                              {"vec3", "float3"},
                              {"vec4", "float4"},
                              {"ivec2", "int2"},
                              {"ivec3", "int3"},
                              {"uvec2", "uint2"},
                              {"uvec3", "uint3"},
                              {"uvec4", "uint4"},
                              {"mat4", "float4x4"},
                              {"fract", "frac"},
                              {"mix", "lerp"},
                              {"inversesqrt", "rsqrt"},
                              {"findLSB", "firstbitlow"},
                              {"uintBitsToFloat", "asfloat"},
                              {"floatBitsToUint", "asuint"}};
  return names;
}

const Names& mslNames() {
  static const Names names = {{"vec2", "float2"},
                              {"vec3", "float3"},
                              {"vec4", "float4"},
                              {"ivec2", "int2"},
                              {"ivec3", "int3"},
                              {"uvec2", "uint2"},
                              {"uvec3", "uint3"},
                              {"uvec4", "uint4"},
                              {"mat4", "float4x4"},
                              {"inversesqrt", "rsqrt"},
                              {"findLSB", "gnomonFindLsb"},
                              {"uintBitsToFloat", "as_type<float>"},
                              {"floatBitsToUint", "as_type<uint>"}};
  return names;
}

std::set<std::string> wordsOf(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

// Words of a language that the shaders use as names.
bool isReserved(Language language, const std::string& name) {
  // Of C++, which both come from.
  static const std::set<std::string> both = wordsOf(
      "auto catch char class delete double enum explicit extern friend goto half inline long mutable namespace "
      "new operator private protected public register short signed sizeof static template texture this throw "
      "try typedef typename union unsigned using virtual volatile static_cast const_cast reinterpret_cast "
      "dynamic_cast export asm");
  // Of HLSL, its types, and functions that are printed for GLSL's.
  static const std::set<std::string> hlsl = wordsOf(
      "point line triangle sample linear center pass out_ vector matrix string compile dword cbuffer tbuffer "
      "technique interface shared groupshared snorm unorm precise column_major row_major packoffset lineadj "
      "triangleadj centroid uniform sampler nointerpolation noperspective globallycoherent min10float "
      "min16float min12int min16int min16uint stateblock "
      "AppendStructuredBuffer BlendState Buffer ByteAddressBuffer ConstantBuffer ConsumeStructuredBuffer "
      "DepthStencilState InputPatch LineStream NULL OutputPatch PointStream RasterizerState RWBuffer "
      "RWByteAddressBuffer RWStructuredBuffer RWTexture1D RWTexture1DArray RWTexture2D RWTexture2DArray "
      "RWTexture3D SamplerComparisonState SamplerState StructuredBuffer SubpassInput SubpassInputMS Texture1D "
      "Texture1DArray Texture2D Texture2DArray Texture2DMS Texture2DMSArray Texture3D TextureBuffer TextureCube "
      "TextureCubeArray TriangleStream "
      "int16_t uint16_t int32_t uint32_t int64_t uint64_t float16_t float32_t float64_t "
      "frac lerp rsqrt firstbitlow asfloat asuint");
  // Of Metal, what else C++14 has, and functions that are printed for GLSL's.
  static const std::set<std::string> msl = wordsOf(
      "constant device thread vertex fragment kernel sampler near far threadgroup constexpr decltype nullptr "
      "noexcept alignas alignof static_assert metal visible ray_data "
      "and and_eq bitand bitor compl not not_eq or or_eq xor xor_eq char16_t char32_t wchar_t thread_local "
      "typeid "
      "uchar ushort ulong size_t ptrdiff_t int8_t uint8_t int16_t uint16_t int32_t uint32_t int64_t uint64_t bfloat "
      "NULL NAN INFINITY HUGE_VAL HUGE_VALF MAXFLOAT MAXHALF CHAR_BIT CHAR_MAX CHAR_MIN SCHAR_MAX SCHAR_MIN SHRT_MAX "
      "SHRT_MIN INT_MAX INT_MIN LONG_MAX LONG_MIN UCHAR_MAX USHRT_MAX UINT_MAX ULONG_MAX assert "
      "as_type ctz rsqrt");
  const auto isMetalConstant = [&] {
    const auto starts = [&](const char* stem) { return name.starts_with(stem); };
    return starts("FLT_") || starts("HALF_") || starts("DBL_") || starts("FP_") || starts("M_");
  };
  if (language != Language::Hlsl && language != Language::Msl) return false;
  if (language == Language::Msl && isMetalConstant()) return true;
  return both.contains(name) || (language == Language::Hlsl ? hlsl : msl).contains(name);
}

// "float1", "int2x3"
bool isShapedType(const std::string& name) {
  for (const char* base :
       {"bool",     "int",     "uint",     "float",      "half",       "double",    "char",      "uchar",     "short",
        "ushort",   "long",    "ulong",    "min10float", "min16float", "min12int",  "min16int",  "min16uint", "int16_t",
        "uint16_t", "int32_t", "uint32_t", "int64_t",    "uint64_t",   "float16_t", "float32_t", "float64_t"}) {
    if (!name.starts_with(base)) continue;
    const std::string shape = name.substr(std::string_view(base).size());
    if (!shape.empty() && shape.find_first_not_of("1234x") == std::string::npos) return true;
  }
  return false;
}

bool startsWithDigit(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) != 0 || text[0] == '.');
}

// Behind a backslash at the end of a line the comment would go on.
std::string comment(const std::string& text) {
  const size_t last = text.find_last_not_of(" \t\r\f\v");
  return "//" + (last != std::string::npos && text[last] == '\\' ? text.substr(0, last + 1) + "." : text);
}

class Printer {
 public:
  explicit Printer(const PrintOptions& options) : options_(options) {}

  std::string name(const std::string& text) const {
    if (locals_.contains(text)) return local(text);
    if (const auto found = options_.names.find(text); found != options_.names.end()) return found->second;
    const std::string own = nameIn(options_.language, text);
    return own == text && isReserved(options_.language, own) ? own + "_" : own;
  }
  std::string local(const std::string& text) const { return variableNameIn(options_.language, text); }

  std::string expr(const Expr& e) const {
    switch (e.kind) {
      case Expr::Kind::Atom:
        return startsWithDigit(e.text) ? e.text : name(e.text);
      case Expr::Kind::Member:
        return expr(e.kids[0]) + "." + local(e.text);
      case Expr::Kind::Index:
        return expr(e.kids[0]) + "[" + expr(e.kids[1]) + "]";
      case Expr::Kind::Call:
        return call(e);
      case Expr::Kind::Prefix:
        return prefixed(e.text, expr(e.kids[0]));
      case Expr::Kind::Postfix:
        return expr(e.kids[0]) + e.text;
      case Expr::Kind::Binary:
        return expr(e.kids[0]) + " " + e.text + " " + expr(e.kids[1]);
      case Expr::Kind::Ternary:
        return expr(e.kids[0]) + " ? " + expr(e.kids[1]) + " : " + expr(e.kids[2]);
      case Expr::Kind::Paren:
        return "(" + expr(e.kids[0]) + ")";
    }
    return {};
  }

  std::string decl(const Decl& d) {
    locals_.clear();
    for (const Param& p : d.params) locals_.insert(p.name);
    eachStmt(d.body, [&](const Stmt& stmt) {
      for (const Declarator& declared : stmt.names) locals_.insert(declared.name);
    });
    if (d.kind == Decl::Kind::Function && !d.hasBody) {
      const auto found = options_.definitions.find(d.name);
      if (found != options_.definitions.end()) return found->second;
    }
    std::string text = commentLines(publicComment(d.comments));
    const std::string trailing = d.trailing.empty() ? "" : "  " + comment(d.trailing);
    if (d.kind == Decl::Kind::Constant) {
      const char* qualifier = options_.language == Language::Hlsl  ? "static const"
                              : options_.language == Language::Msl ? "constant"
                                                                   : "const";
      text += fmt::format("{} {} {} = {};{}\n", qualifier, name(d.type), name(d.name), expr(*d.value), trailing);
    } else if (d.kind == Decl::Kind::Struct) {
      text += fmt::format("struct {} {{\n{}}};\n", name(d.name), body(d.members, 2));
    } else {
      std::string head = options_.language == Language::Msl ? "inline " : "";
      head += fmt::format("{} {}(", name(d.type), name(d.name));
      for (size_t i = 0; i < d.params.size(); ++i) head += (i > 0 ? ", " : "") + param(d.params[i]);
      if (!d.hasBody) {
        text += wrappedCode(head + ");", 0) + trailing + "\n";
      } else if (d.body.size() == 1 && d.body[0].kind == Stmt::Kind::Return && d.body[0].comments.empty() &&
                 head.size() + returned(d.body[0]).size() + 5 <= kPageWidth) {
        text += head + ") { " + returned(d.body[0]) + " }\n";
      } else {
        text += wrappedCode(head + ") {", 0) + "\n" + body(d.body, 2) + "}\n";
      }
    }
    return text;
  }

 private:
  // "- -x", which is not "--x".
  static std::string prefixed(const std::string& sign, const std::string& of) {
    const bool isOfSign = (sign == "-" || sign == "+") && of.starts_with(sign);
    return sign + (isOfSign ? " " : "") + of;
  }

  std::string call(const Expr& e) const {
    const bool isOfFloats = e.text == "vec2" || e.text == "vec3" || e.text == "vec4";
    const bool cLike = options_.language == Language::Hlsl || options_.language == Language::Msl;
    // HLSL's vectors have no constructor that spreads a number.
    if (options_.language == Language::Hlsl && isVector(e.text) && e.kids.size() == 1 && isNumber(e.kids[0])) {
      const std::string number = expr(e.kids[0]);
      std::string text = name(e.text) + "(" + number;
      for (int i = 1; i < componentCount(e.text); ++i) text += ", " + number;
      return text + ")";
    }
    if (isOfFloats && cLike && e.kids.size() == 1 && !isNumber(e.kids[0])) {
      const std::string inner = expr(e.kids[0]);
      const bool simple = e.kids[0].kind != Expr::Kind::Binary && e.kids[0].kind != Expr::Kind::Ternary;
      return (simple ? inner : "(" + inner + ")") + (e.text == "vec2" ? ".xy" : e.text == "vec3" ? ".xyz" : "");
    }
    if (e.text == "uintBitsToFloat" && options_.language == Language::Msl && e.kids[0].kind == Expr::Kind::Member)
      return fmt::format("as_type<float3>({})", expr(e.kids[0]));
    // HLSL's is a whole number.
    if (e.text == "sign" && options_.language == Language::Hlsl && !options_.names.contains(e.text))
      return "(1.0f * sign(" + expr(e.kids[0]) + "))";
    // A variable may have a function's name, which is not meant where it is called.
    const auto function = options_.names.find(e.text);
    std::string text = (function != options_.names.end() ? function->second : name(e.text)) + "(";
    for (size_t i = 0; i < e.kids.size(); ++i) text += (i > 0 ? ", " : "") + expr(e.kids[i]);
    return text + ")";
  }

  std::string param(const Param& p) const {
    if (p.qualifier.empty()) return name(p.type) + " " + local(p.name);
    if (options_.language == Language::Msl) return "thread " + name(p.type) + "& " + local(p.name);
    return p.qualifier + " " + name(p.type) + " " + local(p.name);
  }

  static const Expr& bare(const Expr& e) { return e.kind == Expr::Kind::Paren ? e.kids[0] : e; }

  std::string returned(const Stmt& stmt) const {
    return stmt.expr ? "return " + expr(bare(*stmt.expr)) + ";" : "return;";
  }

  std::string declaration(const Stmt& stmt) const {
    std::string text;
    for (const std::string& qualifier : stmt.qualifiers)
      if (qualifier != "precise" || options_.language == Language::Glsl || options_.language == Language::Hlsl)
        text += qualifier + " ";
    text += name(stmt.type) + " ";
    for (size_t i = 0; i < stmt.names.size(); ++i) {
      const Declarator& d = stmt.names[i];
      text += (i > 0 ? ", " : "") + local(d.name);
      if (d.count) text += "[" + expr(*d.count) + "]";
      if (!d.value) continue;
      // HLSL and Metal have no constructors of structures.
      const bool isStruct =
          d.value->kind == Expr::Kind::Call && d.value->text == stmt.type && options_.names.contains(stmt.type);
      if (isStruct && (options_.language == Language::Hlsl || options_.language == Language::Msl)) {
        text += " = {";
        for (size_t k = 0; k < d.value->kids.size(); ++k) text += (k > 0 ? ", " : "") + expr(d.value->kids[k]);
        text += "}";
      } else {
        text += " = " + expr(bare(*d.value));
      }
    }
    return text + ";";
  }

  std::string simple(const Stmt& stmt) const {
    switch (stmt.kind) {
      case Stmt::Kind::Declaration:
        return declaration(stmt);
      case Stmt::Kind::Return:
        return returned(stmt);
      case Stmt::Kind::Break:
        return "break;";
      case Stmt::Kind::Continue:
        return "continue;";
      default:
        return expr(*stmt.expr) + ";";
    }
  }

  static bool isSimple(const Stmt& stmt) {
    return stmt.kind == Stmt::Kind::Expression || stmt.kind == Stmt::Kind::Declaration ||
           stmt.kind == Stmt::Kind::Return || stmt.kind == Stmt::Kind::Break || stmt.kind == Stmt::Kind::Continue;
  }

  std::string body(const std::vector<Stmt>& stmts, int indent) const {
    std::string text;
    for (const Stmt& stmt : stmts) text += statement(stmt, indent);
    return text;
  }

  // What hangs on an if or a loop: on its line where it is short, else in braces.
  std::string hanging(const std::string& head, const std::vector<Stmt>& stmts, int indent, bool mayBeShort) const {
    const std::string pad(static_cast<size_t>(indent), ' ');
    if (mayBeShort && stmts.size() == 1 && isSimple(stmts[0]) && stmts[0].comments.empty() &&
        stmts[0].trailing.empty()) {
      const std::string line = pad + head + " " + simple(stmts[0]);
      if (line.size() <= kPageWidth) return line + "\n";
    }
    return wrappedCode(pad + head + " {", indent) + "\n" + body(stmts, indent + 2) + pad + "}\n";
  }

  std::string statement(const Stmt& stmt, int indent) const {
    const std::string pad(static_cast<size_t>(indent), ' ');
    std::string text = commentLines(publicComment(stmt.comments), indent);
    const std::string trailing = stmt.trailing.empty() ? "" : "  " + comment(stmt.trailing);
    if (isSimple(stmt)) return text + wrappedCode(pad + simple(stmt) + trailing, indent) + "\n";
    switch (stmt.kind) {
      case Stmt::Kind::Block:
        return text + pad + "{\n" + body(stmt.body, indent + 2) + pad + "}\n";
      case Stmt::Kind::While:
        return text + hanging("while (" + expr(bare(*stmt.expr)) + ")", stmt.body, indent, true);
      case Stmt::Kind::For: {
        std::string head = "for (" + (stmt.other.empty() ? ";" : simple(stmt.other[0])) + " " +
                           (stmt.expr ? expr(*stmt.expr) : "") + "; " + (stmt.step ? expr(*stmt.step) : "") + ")";
        return text + hanging(head, stmt.body, indent, true);
      }
      case Stmt::Kind::If: {
        text += hanging("if (" + expr(bare(*stmt.expr)) + ")", stmt.body, indent, stmt.other.empty());
        if (stmt.other.empty()) return text;
        text.pop_back();
        if (stmt.other.size() == 1 && stmt.other[0].kind == Stmt::Kind::If && stmt.other[0].comments.empty()) {
          const std::string chained = statement(stmt.other[0], indent);
          return text + " else " + chained.substr(static_cast<size_t>(indent));
        }
        return text + " else {\n" + body(stmt.other, indent + 2) + pad + "}\n";
      }
      case Stmt::Kind::Switch: {
        text += pad + "switch (" + expr(bare(*stmt.expr)) + ") {\n";
        for (const Stmt::Case& one : stmt.cases) {
          for (const Expr& label : one.labels) text += pad + "  case " + expr(label) + ":\n";
          if (one.labels.empty()) text += pad + "  default:\n";
          const bool declares =
              std::ranges::any_of(one.body, [](const Stmt& s) { return s.kind == Stmt::Kind::Declaration; });
          if (declares) text.insert(text.size() - 1, " {");
          text += body(one.body, indent + 4);
          if (declares) text += pad + "  }\n";
        }
        return text + pad + "}\n";
      }
      default:
        return text;
    }
  }

  const PrintOptions& options_;
  std::set<std::string> locals_;  // of the declaration that is printed
};

}  // namespace

const std::vector<std::string>& languageNames() {
  static const std::vector<std::string> names = {"glsl", "glsl-es", "hlsl", "msl"};
  return names;
}

std::string nameIn(Language language, const std::string& glslName) {
  static const Names none, es = {{"findLSB", "gnomonFindLsb"}};
  const Names& names = language == Language::Hlsl     ? hlslNames()
                       : language == Language::Msl    ? mslNames()
                       : language == Language::GlslEs ? es
                                                      : none;
  const auto found = names.find(glslName);
  return found == names.end() ? glslName : found->second;
}

std::string variableNameIn(Language language, const std::string& name) {
  const bool isCLike = language == Language::Hlsl || language == Language::Msl;
  return isReserved(language, name) || (isCLike && isShapedType(name)) ? name + "_" : name;
}

std::string commentLines(const std::vector<std::string>& lines, int indent) {
  std::string text;
  for (const std::string& line : lines) text += std::string(static_cast<size_t>(indent), ' ') + comment(line) + "\n";
  return text;
}

std::vector<std::string> publicComment(const std::vector<std::string>& lines) {
  static const char* const kInternal[] = {
      "`known`",          "magenta",      "kDiagnose",  "Part of shared/",
      "compiled once",    "lavapipe",     "To add one", "Filtered results are scored",
      "three to 5 times", "results.json", "docs/"};
  const auto isInternal = [](const std::string& text) {
    return std::ranges::any_of(kInternal, [&](const char* word) { return text.find(word) != std::string::npos; });
  };
  std::vector<std::string> out;
  for (size_t begin = 0; begin < lines.size();) {
    size_t end = begin;
    while (end < lines.size() && !lines[end].empty()) ++end;
    bool prose = true, internal = false;
    std::string joined;
    for (size_t i = begin; i < end; ++i) {
      const std::string& line = lines[i];
      prose = prose && line.size() > 1 && line[0] == ' ' && line[1] != ' ' && line[1] != '-' &&
              line.find("   ") == std::string::npos;
      internal = internal || isInternal(line);
      joined += line;
    }
    internal = internal || isInternal(joined);
    if (!prose || !internal) {
      out.insert(out.end(), lines.begin() + static_cast<std::ptrdiff_t>(begin),
                 lines.begin() + static_cast<std::ptrdiff_t>(end));
    } else {
      std::string kept;
      for (size_t at = 0; at < joined.size();) {
        size_t stop = joined.find(". ", at);
        stop = stop == std::string::npos ? joined.size() : stop + 1;
        const std::string sentence = joined.substr(at, stop - at);
        if (!isInternal(sentence)) kept += sentence;
        at = stop;
      }
      for (std::string rest = kept; !rest.empty();) {
        size_t cut = rest.size() <= kPageWidth - 2 ? rest.size() : rest.rfind(' ', kPageWidth - 2);
        if (cut == 0 || cut == std::string::npos) cut = rest.size();
        out.push_back(rest.substr(0, cut));
        rest = rest.substr(cut);
      }
    }
    if (end < lines.size() && !out.empty() && !out.back().empty()) out.emplace_back();
    begin = end + 1;
  }
  while (!out.empty() && out.back().empty()) out.pop_back();
  return out;
}

std::string wrappedCode(const std::string& line, int indent) {
  if (line.size() <= kPageWidth) return line;
  const std::string_view breakAfter = ",&|?:+-*={";
  size_t at = std::string::npos;
  // Where a comment stands behind it, only what is before. Of all places those within the fewest parentheses, and of
  // these the last.
  const size_t comment = line.find("  //");
  int depth = 0, least = 1000;
  for (size_t i = static_cast<size_t>(indent); i < line.size() && i <= kPageWidth && i < comment; ++i) {
    if (line[i] == '(') ++depth;
    if (line[i] == ')') --depth;
    if (i < static_cast<size_t>(indent) + 40 || line[i] != ' ' ||
        breakAfter.find(line[i - 1]) == std::string_view::npos)
      continue;
    const int price = 2 * depth + (line[i - 1] == '*' || line[i - 1] == '-' || line[i - 1] == '=' ? 1 : 0);
    if (price > least) continue;
    least = price;
    at = i;
  }
  if (at == std::string::npos) return line;
  const std::string rest = std::string(static_cast<size_t>(indent) + 4, ' ') + line.substr(at + 1);
  return line.substr(0, at) + "\n" + wrappedCode(rest, indent);
}

std::string printDecl(const Decl& decl, const PrintOptions& options) {
  return Printer(options).decl(decl);
}

std::string printProgram(const Program& program, const PrintOptions& options) {
  std::string text, file;
  bool lastWasShort = false;
  for (const Decl& decl : program.decls) {
    if (decl.file != file) {
      file = decl.file;
      lastWasShort = false;
      for (const auto& [name, lines] : program.heads)
        if (name == file && !options.withoutHead.contains(file)) text += "\n" + commentLines(publicComment(lines));
    }
    const bool isShort = decl.kind == Decl::Kind::Constant;
    if (!(isShort && lastWasShort)) text += "\n";
    lastWasShort = isShort;
    text += printDecl(decl, options);
  }
  return text;
}

std::string prefixedName(const Decl& decl) {
  std::string rest = decl.name;
  if (decl.kind == Decl::Kind::Struct) return "Gnomon" + rest;
  if (decl.kind == Decl::Kind::Constant) return rest.starts_with('k') ? "kGnomon" + rest.substr(1) : "kGnomon_" + rest;
  rest[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(rest[0])));
  return "gnomon" + rest;
}

std::map<std::string, std::string> prefixedNames(const Program& program) {
  std::map<std::string, std::string> names;
  for (const Decl& decl : program.decls) names[decl.name] = prefixedName(decl);
  return names;
}

}  // namespace gnomon::code
