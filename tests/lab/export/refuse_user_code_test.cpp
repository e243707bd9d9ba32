// What export reads of the file of a user's bias, and that it tells by line what it refuses.
#include "base/error.h"
#include "lab/export/expressions.h"
#include "lab/export/visibility_source.h"
#include "shadow/user_bias.h"
#include "tests/lab/export/what_to_export.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using code::Language;
using test::choiceOf;
using test::kinds;
using test::kUserHead;
using test::mentions;

// What export says of a user's file; empty where it is exported.
std::string refusal(const std::string& glsl, Language language = Language::Glsl) {
  try {
    const auto user = readUserBias("mine.glsl", glsl);
    exportShader(choiceOf(kinds()[1], user->method, filters()[0], language));
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(ExportOfUserCode, WhatItMayNotUseIsToldByItsLine) {
  for (const char* line : {"do { } while (false);", "#if 1\n#endif", "#pragma optionNV(fastmath off)"}) {
    const std::string said = refusal(fmt::format("{} {{\n{}\n  return true;\n}}\n", kUserHead, line));
    EXPECT_TRUE(said.starts_with("mine.glsl:2: ")) << line << ": " << said;
  }
}

// Gnomon's own code is folded; a user's may have effects and names where that would change it.
TEST(ExportOfUserCode, StaysAsItIsWritten) {
  struct Case {
    const char *helpers, *body, *exported;
  };
  for (const Case& one : std::vector<Case>{
           {"float same(float a) { return a; }", "return same(x + 1.0f) * 2.0f > 3.0f;",
            "gnomonSame(x + 1.0f) * 2.0f > 3.0f"},
           {"float real(int i) { return i; }", "return real(n) / 2 > 0.6f;", "gnomonReal(n) / 2 > 0.6f"},
           {"bool yes(int i) { return true; }", "bool b = yes(n++); return b && n > 1;", "bool b = gnomonYes(n++);"},
           {"float twice(float a, int b) { return a * 2.0f; }", "return twice(x, n++) > 0.5f && n > 1;",
            "gnomonTwice(x, n++) > 0.5f && n > 1"},
           {"struct Two { float one; float two; };",
            "Two s; s.one = x; s.two = float(n++); return s.one > 0.5f && n > 1;", "s.two = float(n++);"},
           {"struct Two { float one; float two; };",
            "Two a; Two b; a.one = x; a.two = x; b.one = x; b.two = 0.0f; bool e = a == b; return e && a.one > 0.0f;",
            "b.two = 0.0f;"},
           {"struct Own { vec2 xy; float foo; };",
            "vec3 v = vec3(x); Own s; s.xy = vec2(x); s.foo = 1.0f; v.xy = vec2(0.0f, 0.0f); return v.x + s.foo > "
            "0.5f;",
            "v.xy = vec2(0.0f, 0.0f);"},
           {"", "float s = 0.0f; for (float t = 0.0f; t < 1.0f; t += 0.25f) s += x; return s > 1.0f;", "t += 0.25f"},
           {"", "switch (1) { case 1: x += 1.0f; case 2: x += 2.0f; break; } return x > 1.0f;", "x += 2.0f;"},
           {"", "float dead = float(n++); return n > 1;", "float dead = float(n++);"},
           {"", "if (n++ > 0) { } return n > 1;", "n++ > 0"},
           {"", "if ((++n > 0) && false) { x = 2.0f; } return n > 1 && x > 0.5f;", "(++n > 0) && false"},
           {"", "float y = 1.0f; if (n > 0) { if (true) { float y = 3.0f; x += y; } x += y; } return x > 2.0f;",
            "if (true)"},
           {"", "if (16777217.0f == 16777216.0f) return x > 0.5f; return false;", "16777217.0f == 16777216.0f"},
           {"", "if (kMapKind == kMapCube) return x > 0.5f; return false;", "if (1 == kGnomonMapCube)"},
       }) {
    const auto user = readUserBias(
        "mine.glsl",
        fmt::format("{}\n{} {{\n  float x = tap.z1; int n = tap.slice;\n  {}\n}}\n", one.helpers, kUserHead, one.body));
    const std::string text = exportShader(choiceOf(kinds()[1], user->method, filters()[0], Language::Glsl)).text;
    EXPECT_TRUE(mentions(text, one.exported)) << one.body << "\n" << text.substr(text.rfind("\nbool gnomonUserLit"));
  }
  EXPECT_TRUE(
      mentions(refusal(fmt::format("{} {{\n  map.width = 5;\n  return map.width > tap.slice;\n}}\n", kUserHead)),
               "mine.glsl:2: map.width is a constant in exported code"));
  EXPECT_TRUE(mentions(
      refusal(fmt::format("{} {{\n  int n = 0;\n  return mapDepth(map, n++, receiver.posL) > 0.5f;\n}}\n", kUserHead)),
      "mine.glsl:3: an argument of mapDepth writes to a variable"));
}

TEST(ExportOfUserCode, WhatItDoesNotReadIsNamed) {
  EXPECT_EQ(
      refusal(fmt::format("{} {{\n  int i = 0;\n  do {{ ++i; }} while (i < 3);\n  return true;\n}}\n", kUserHead)),
      "mine.glsl:3: export does not read do-while loops; write a for or a while");
  const std::string arrays = "export does not read arrays of constants; write a function with a switch";
  for (const char* array : {"const float k[3] = float[3](0.1f, 0.2f, 0.3f);", "const float k[] = float[](0.1f, 0.2f);",
                            "const float[2] k = float[2](0.1f, 0.2f);", "const float k[2] = {0.1f, 0.2f};"}) {
    const std::string global = refusal(fmt::format("\n{}\n{} {{ return tap.z1 > k[1]; }}\n", array, kUserHead));
    EXPECT_TRUE(global.starts_with("mine.glsl:2: " + arrays)) << array << ": " << global;
    if (std::string(array).find('{') != std::string::npos) continue;
    const std::string local = refusal(fmt::format("{} {{\n  {}\n  return tap.z1 > k[1]; }}\n", kUserHead, array));
    EXPECT_TRUE(local.starts_with("mine.glsl:2: " + arrays)) << array << ": " << local;
  }
}

// In the order in which GLSL wants them; the text of what nobody declares before is as it was.
TEST(ExportOfUserCode, WhatIsDeclaredFirstIsDefinedFirst) {
  const std::string text = fmt::format(
      "float later(float a);\n{} {{ return later(tap.z1) > 0.5f; }}\nconst float kHalf = 0.5f;\n"
      "float last(float a);\nfloat later(float a) {{ float b = last(a); return b * kHalf * b; }}\n"
      "float last(float a) {{ float b = a * a; return b + a; }}\n",
      kUserHead);
  const auto user = readUserBias("mine.glsl", text);
  for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl}) {
    const std::string code = exportShader(choiceOf(kinds()[1], user->method, filters()[0], language)).text;
    const size_t constant = code.find("kGnomonHalf"), last = code.find("gnomonLast("),
                 later = code.find("gnomonLater("), lit = code.find("gnomonUserLit(");
    EXPECT_LT(constant, later);
    EXPECT_LT(last, later);
    EXPECT_LT(later, lit);
    EXPECT_NE(lit, std::string::npos) << code;
  }
}

TEST(ExportOfUserCode, BrokenDirectivesAreToldByTheirLine) {
  const std::string body = std::string(kUserHead) + " { return tap.z1 > 0.5f; }\n";
  for (const char* directive :
       {"#endif", "#else", "#elif", "#iffy", "#ifdef", "#ifndef", "#undef", "#define", "#define F(a", "#line",
        "#line x", "#ifdef A\n#else\n#else\n#endif", "#define F(a, b) a\nfloat x() { return F(1.0f); }",
        "#define F(a) a\nfloat x() { return F(1.0f; }", "#ifdef A", "/* no end"}) {
    const std::string said = refusal(fmt::format("\n{}\n{}", directive, body));
    EXPECT_TRUE(std::regex_search(said, std::regex("^mine\\.glsl:[2-5]: [^\n]*; [^\n]+$")))
        << directive << ": " << said;
  }
}

TEST(ExportOfUserCode, CommentsAreNoCode) {
  const std::string body = std::string(kUserHead) + " { return tap.z1 > /* 1 +\n */ 0.5f; }\n";
  for (const char* comment : {"/*\n#endif\n#else\n*/", "/* #ifdef */ // /*", "#define A /* goes\n on */ 1.0f",
                              "// /*\n#ifdef A\n/* #endif */\n#endif"})
    EXPECT_EQ(refusal(std::string(comment) + "\n" + body), "") << comment;
  // Lines are counted through them.
  const std::string said = refusal("/*\n\n*/ /*\n*/\n" + body + "\n#endif\n");
  EXPECT_TRUE(said.starts_with("mine.glsl:8: ")) << said;
}

TEST(ExportOfUserCode, LinesAreThoseOfTheFile) {
  for (const char* line : {"#line 77", "#line 5 \"name\"", "  # line 99999999999"}) {
    const std::string said =
        refusal(fmt::format("{}\n{} {{\n  do {{ }} while (false);\n  return true; }}\n", line, kUserHead));
    EXPECT_TRUE(said.starts_with("mine.glsl:3: ")) << line << ": " << said;
  }
}

TEST(ExportOfUserCode, ContinuedLinesMayEndAsOnWindows) {
  EXPECT_EQ(refusal(fmt::format("#define A \\\r\n  0.5f\r\n{} {{ return tap.z1 > A; }}\r\n", kUserHead)), "");
}

TEST(ExportOfUserCode, AMacroIsAPlainNameWithinItself) {
  EXPECT_EQ(refusal(fmt::format("#define foo bar\n#define bar foo\n#define twice(x) (x + x)\n{} {{ float foo = 1.0f; "
                                "return twice(twice(foo)) > tap.z1; }}\n",
                                kUserHead)),
            "");
}

TEST(ExportOfUserCode, WhatIsTooDeepOrTooLongIsToldByItsLine) {
  const auto isTold = [](const std::string& code, const char* what) {
    const std::string said = refusal(fmt::format("#define P(x) (x)\n{}\n{} {{ return true; }}\n", code, kUserHead));
    EXPECT_TRUE(said.starts_with("mine.glsl:") && mentions(said, what) && !mentions(said, "\n")) << said;
  };
  const int many = 20000;
  const auto function = [](const std::string& body) { return "float f(float a) { " + body + " return a; }"; };
  isTold(function("a = " + repeated("(", many) + "1.0f" + repeated(")", many) + ";"), "levels deep");
  isTold(function("a = " + repeated("- ", many) + "1.0f;"), "levels deep");
  isTold(function("a = 1.0f" + repeated("+1.0f", many) + ";"), "levels deep");
  isTold(function("a = a" + repeated("[0]", many) + ";"), "levels deep");
  isTold(function("a = " + repeated("true ? 1.0f : ", many / 8) + "0.0f;"), "levels deep");
  isTold(function(repeated("{", many) + repeated("}", many)), "levels deep");
  isTold(function(repeated("if (a > 0.0f) a = 1.0f; else ", many / 16) + ";"), "levels deep");
  isTold(function("a = " + repeated("P(", many) + "1.0f" + repeated(")", many) + ";"), "deep within macros");
  std::string doubling = "#define A0 1.0f\n";
  for (int i = 0; i < 40; ++i) doubling += fmt::format("#define A{} A{} + A{}\n", i + 1, i, i);
  isTold(doubling + "const float big = A40;", "more than");
  std::string chain = "#define A0 1.0f\n";
  for (int i = 0; i < 1000; ++i) chain += fmt::format("#define A{} A{}\n", i + 1, i);
  isTold(chain + "const float big = A1000;", "deep within macros");
}

TEST(ExportOfUserCode, NamesThatAreFoldedAreRefused) {
  for (const char* name : {"known", "kind", "reach", "priorityId", "filterKnown", "lightFrame", "tap", "asking"}) {
    const std::string local = fmt::format("float f(float a) {{\n  float {} = a;\n  return a; }}\n", name);
    const std::string param = fmt::format("\nfloat f(float {}) {{ return 1.0f; }}\n", name);
    for (const std::string& code : {local, param}) {
      const std::string said = refusal(code + kUserHead + " { return f(1.0f) > tap.z1; }\n");
      EXPECT_TRUE(said.starts_with(fmt::format("mine.glsl:2: '{}' ", name))) << said;
    }
  }
  EXPECT_TRUE(refusal(std::string("float reach(float a) { return a; }\n") + kUserHead + " { return true; }\n")
                  .starts_with("mine.glsl:1: 'reach' "));
}

TEST(ExportOfUserCode, WhatIsNotTranslatedIsToldByItsLine) {
  for (const auto& [code, word] :
       {std::pair{"mat3 m = mat3(1.0f);", "mat3"}, std::pair{"float a = mod(tap.z1, 1.0f);", "mod"},
        std::pair{"bvec2 b = bvec2(true);", "bvec2"},
        std::pair{"vec2 f = vec2(tap.z1);", "write vec2(tap.z1, tap.z1), or"}, std::pair{"double d = 1.0;", "double"},
        std::pair{"float t = atan(tap.z1, 2.0f);", "atan of two"}, std::pair{"float d = float(1.0lf);", "1.0lf"},
        std::pair{"vec3 v = vec3(receiver.normalL);", "write receiver.normalL.xyz, or"},
        std::pair{"vec2 v = vec2(tap.texel.xy);", "vec2(tap.texel.xy) of whole numbers"},
        std::pair{"vec2 v = vec2(tap.z1 * 2.0f);", "write vec2(x, x), or"}}) {
    const std::string file = fmt::format("{} {{\n  {}\n  return true; }}\n", kUserHead, code);
    for (const Language language : {Language::Hlsl, Language::Msl}) {
      const std::string said = refusal(file, language);
      EXPECT_TRUE(said.starts_with("mine.glsl:2: ")) << said;
      EXPECT_TRUE(mentions(said, word)) << code << ": " << said;
      EXPECT_TRUE(mentions(said, "or export --lang glsl")) << said;
    }
    EXPECT_EQ(refusal(file), "") << code;
  }
  const std::string fine =
      std::string(kUserHead) + " { vec3 v = vec3(0.5f); vec2 f = vec2(v.xy); return f.x > tap.z1; }\n";
  for (const Language language : {Language::Hlsl, Language::Msl}) EXPECT_EQ(refusal(fine, language), "");
}

// Which are true or false in GLSL, and vectors of such in HLSL and Metal.
TEST(ExportOfUserCode, ComparisonsOfVectorsAreToldByTheirLine) {
  const std::string declared =
      "struct Mine { vec2 v; float f[2]; };\nvec3 up() { return vec3(0.0f, 1.0f, 0.0f); }\n"
      "Mine made() { Mine mine; mine.v = vec2(1.0f, 2.0f); mine.f[0] = mine.f[1] = 1.0f; return mine; }\n"
      "#define AT receiver.posL\n";
  const auto file = [&](const char* comparison) {
    return fmt::format(
        "{}{} {{\n  vec3 local = up(), other; float number = 1.0f; Mine mine = made();\n  bool first = number == "
        "1.0f;\n"
        "  {{ float local = 2.0f; first = local == number; }}\n  bool same = {};\n  return first && same; }}\n",
        declared, kUserHead, comparison);
  };
  for (const char* comparison :
       {"receiver.normalL == vec3(0.0f, 0.0f, 1.0f)", "local != other", "number == 1.0f && local == other",
        "tap.texel == ivec2(1, 2)", "mine.v == mine.v.yx", "made().v != mine.v", "up() == other", "AT == up()",
        "local.xy == mine.v", "local * 2.0f == other", "2.0f * local == -other", "(local) == other",
        "normalize(local) == other", "(number > 1.0f ? local : other) == other", "mine == made()", "mine.f == mine.f"})
    for (const Language language : {Language::Hlsl, Language::Msl}) {
      const std::string said = refusal(file(comparison), language);
      EXPECT_TRUE(said.starts_with("mine.glsl:9: ")) << comparison << ": " << said;
      EXPECT_TRUE(mentions(said, "; compare them number by number, or export --lang glsl")) << said;
      EXPECT_EQ(refusal(file(comparison)), "") << comparison;
    }
  for (const char* comparison :
       {"local.x == other.y", "mine.f[1] == 1.0f", "local[0] != other[1]", "dot(local, other) == 1.0f",
        "length(local) == number", "tap.texel.x == 3", "up().x == number", "(local.x > 1.0f) == (other.x > 1.0f)"})
    for (const Language language : {Language::Hlsl, Language::Msl})
      EXPECT_EQ(refusal(file(comparison), language), "") << comparison;
}

TEST(ExportOfUserCode, WhatHlslAlwaysEvaluatesIsToldByItsLine) {
  const auto file = [](const char* condition) {
    return fmt::format(
        "float put(float a, out float b) {{ b = a; return a; }}\nfloat plain(float a) {{ a += 1.0f; return a; }}\n{} "
        "{{\n"
        "  float a = 1.0f, b = 2.0f; int i = 0; bool first = a > 0.5f && b > 1.0f;\n  bool lit = {};\n"
        "  return first && lit; }}\n",
        kUserHead, condition);
  };
  for (const char* condition :
       {"a > 1.0f && (b = 1.0f) > 0.5f", "a > 1.0f || (b += a) > 0.5f", "a > 1.0f && i++ > 0", "a > 1.0f || --i > 0",
        "a > 1.0f && put(a, b) > 1.0f", "a > 1.0f ? put(a, b) > 1.0f : first", "a > 1.0f ? first : !(i++ > 0)"}) {
    const std::string said = refusal(file(condition), Language::Hlsl);
    EXPECT_TRUE(said.starts_with("mine.glsl:5: ")) << condition << ": " << said;
    EXPECT_TRUE(mentions(said, "write it with if, or export --lang glsl")) << said;
    EXPECT_EQ(refusal(file(condition), Language::Msl), "") << condition;
    EXPECT_EQ(refusal(file(condition)), "") << condition;
  }
  for (const char* condition : {"(b = 1.0f) > 0.5f && a > 1.0f", "put(a, b) > 1.0f || first",
                                "a > 1.0f && plain(a) > 1.0f", "(i++ > 0 ? a : b) > 1.0f"})
    EXPECT_EQ(refusal(file(condition), Language::Hlsl), "") << condition;
}

TEST(ExportOfUserCode, HlslSpreadsNoNumberAndMultipliesNoMatrix) {
  const auto file = [](const char* line) {
    return fmt::format("{} {{ int i = tap.slice;\n  {}\n  return true; }}\n", kUserHead, line);
  };
  for (const auto& [line, remedy] :
       {std::pair{"ivec2 a = ivec2(i);", "write ivec2(i, i), or"},
        std::pair{"vec4 a = GNOMON_MEMBER_ARRAY(map, mapSlices)[i].clipFromLight * vec4(receiver.posL, 1.0f);",
                  "write transform(m, v), or"},
        std::pair{"MapSlice s = GNOMON_MEMBER_ARRAY(map, mapSlices)[i]; vec4 a = s.clipFromLight[0] * s.lightFromClip;",
                  "write transform(m, v), or"}}) {
    const std::string said = refusal(file(line), Language::Hlsl);
    EXPECT_TRUE(said.starts_with("mine.glsl:2: ") && mentions(said, remedy)) << line << ": " << said;
    EXPECT_EQ(refusal(file(line), Language::Msl), "") << line;
  }
  const auto user =
      readUserBias("mine.glsl", fmt::format("{} {{ vec3 a = vec3(0.5f), b = vec3(-.5f); uvec2 c = uvec2(3u);"
                                            " return a.x + b.x + float(c.x) > tap.z1; }}\n",
                                            kUserHead));
  const auto exported = [&](Language language) {
    return exportShader(choiceOf(kinds()[1], user->method, filters()[0], language)).text;
  };
  EXPECT_TRUE(mentions(exported(Language::Hlsl), "float3(0.5f, 0.5f, 0.5f), b = float3(-.5f, -.5f, -.5f)"));
  EXPECT_TRUE(mentions(exported(Language::Hlsl), "uint2(3u, 3u)"));
  EXPECT_TRUE(mentions(exported(Language::Msl), "float3(0.5f), b = float3(-.5f)"));
}

// What is exported beside the user's code keeps to the same.
TEST(ExportOfUserCode, GnomonsOwnCodeHasNothingOfThis) {
  const code::Program& program = code::readVisibility({});
  size_t comparisons = 0, conditions = 0;
  for (const code::Decl& decl : program.decls)
    code::eachExprAndItsVariables(decl, [&](const code::Expr& e, const code::Variables& variables) {
      if (e.text == "==" || e.text == "!=") {
        ++comparisons;
        for (const code::Expr& kid : e.kids)
          EXPECT_FALSE(code::isVector(code::typeOf(kid, variables, program))) << decl.file << ":" << e.line;
      }
      if (e.text != "&&" && e.text != "||" && e.kind != code::Expr::Kind::Ternary) return;
      ++conditions;
      for (size_t i = 1; i < e.kids.size(); ++i)
        EXPECT_FALSE(code::writesVariable(e.kids[i], program)) << decl.file << ":" << e.line;
    });
  EXPECT_GT(comparisons, 50u);
  EXPECT_GT(conditions, 50u);
}

TEST(ExportOfUserCode, KnobsAreReadByTheirConstants) {
  const std::string head =
      fmt::format("//! knob: width metres 0 10 0.01\n{} {{ float w = params.knobs[kUserWidth];\n", kUserHead);
  for (const char* line :
       {"float a = params.knobs[0];", "float a = params.knobs[int(tap.z1)];", "params.knobs[kUserWidth] = 0.3f;",
        "params.knobs[kUserWidth] += 0.3f;", "++params.knobs[kUserWidth];", "BiasParams q = params; q.knobs[0] = 1.0f;",
        "const int place = kUserWidth;"}) {
    const std::string said = refusal(fmt::format("{}  {}\n  return tap.z1 > 0.5f; }}\n", head, line));
    EXPECT_TRUE(said.starts_with("mine.glsl:3: ")) << line << ": " << said;
    EXPECT_TRUE(mentions(said, "; write params.knobs[kUserWidth], read only")) << said;
  }
  EXPECT_TRUE(mentions(refusal(head + "  BiasParams all = params; return float(all.epsilonAt) > tap.z1; }\n"),
                       "mine.glsl:2: userLit uses its"));
  EXPECT_EQ(refusal("float half_(BiasParams q) {\n  return 0.5f * q.knobs[kUserWidth];\n}\n" + head +
                    "  return half_(params) > tap.z1; }\n"),
            "");
}

TEST(ExportOfUserCode, NamesThatCollideOnceTheyHaveAPrefixAreRefused) {
  const std::string f = "(float x) {\n  if (x > 1.0f) return 0.0f;\n  return x; }\n";
  for (const auto& [code, name] :
       {std::pair{"\nfloat depth" + f, "depth"}, std::pair{"float foo(int i) { return 1.0f; } \nfloat Foo" + f, "Foo"},
        std::pair{std::string("float x() { return 1.0f; }\nfloat f(float gnomonX) { return gnomonX; }\n"), "'gnomonX'"},
        std::pair{std::string("\nconst float kMapSide = 1.0f;\n"), "kMapSide"},
        std::pair{std::string("\nconst float kIdShift = 1.0f;\n"), "kIdShift"}}) {
    const std::string said = refusal(code + kUserHead + " { return true; }\n");
    EXPECT_TRUE(said.starts_with(fmt::format("mine.glsl:2: {} ", name))) << said;
    EXPECT_TRUE(mentions(said, "; rename it")) << said;
  }
}

TEST(ExportOfUserCode, NamesThatCollideOnceTheyHaveAnUnderscoreAreRefused) {
  const std::string body = std::string(kUserHead) + " { return tap.z1 > 0.5f; }\n";
  for (const auto& [code, language] :
       {std::pair{"float f(float frac_) {\n  float frac = 1.0f;\n  return frac + frac_; }\n", Language::Hlsl},
        std::pair{"float f(float device_) {\n  float device = 1.0f;\n  return device + device_; }\n", Language::Msl},
        std::pair{"struct Mine { float float3_;\n  float float3; };\n", Language::Hlsl}}) {
    const std::string said = refusal(code + body, language);
    EXPECT_TRUE(said.starts_with("mine.glsl:2: ") && mentions(said, "_, as is ")) << said;
    EXPECT_EQ(refusal(code + body), "");
  }
  // In two functions they do not meet.
  EXPECT_EQ(
      refusal("float f(float frac) { return frac; }\nfloat g(float frac_) { return frac_; }\n" + body, Language::Hlsl),
      "");
}

TEST(ExportOfUserCode, ANameIsToldWhereItIsDeclared) {
  for (const char* declared : {"float tap = 0.5f;", "float a = max(1.0f, 2.0f), tap = a;"}) {
    const std::string said = refusal(
        fmt::format("{} {{\n  return tap.z1 > 0.5f; }}\nfloat f() {{\n  float b = 1.0f;\n  {}\n  return b; }}\n",
                    kUserHead, declared));
    EXPECT_TRUE(said.starts_with("mine.glsl:5: 'tap' ")) << said;
  }
}

TEST(ExportOfUserCode, WhatOnlyTheCompilerKnowsIsNotAsked) {
  for (const char* name : {"GL_ARB_gpu_shader5", "GL_KHR_vulkan_glsl", "GL_FRAGMENT_PRECISION_HIGH"})
    for (const char* word : {"ifdef", "ifndef"}) {
      const std::string said = refusal(fmt::format("\n#{} {}\n#endif\n{} {{ return true; }}\n", word, name, kUserHead));
      EXPECT_TRUE(said.starts_with("mine.glsl:2: ") && mentions(said, name)) << said;
    }
  EXPECT_EQ(refusal(fmt::format("#ifndef __MINE\n#define __MINE\n#endif\n#define GL_MINE\n#ifdef "
                                "GL_MINE\n#endif\n#ifdef NONE\n#ifdef GL_OTHER\n#endif\n#endif\n"
                                "{} {{ return true; }}\n",
                                kUserHead)),
            "");
}

TEST(ExportOfUserCode, VariablesOfTheCallingShaderAreRefused) {
  for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl}) {
    const std::string said =
        refusal(fmt::format("{} {{\n  uint i = gl_GlobalInvocationID.x;\n  return true; }}\n", kUserHead), language);
    EXPECT_TRUE(said.starts_with("mine.glsl:2: gl_GlobalInvocationID is ")) << said;
  }
  const std::string said =
      refusal(fmt::format("{} {{\n  return mapSlices[tap.slice].clipFromLight[0].x > tap.z1; }}\n", kUserHead));
  EXPECT_TRUE(said.starts_with("mine.glsl:2: mapSlices is ")) << said;
}

TEST(ExportOfUserCode, WhatGlslEsDoesNotHaveIsToldByItsLine) {
  for (const auto& [code, word] :
       {std::pair{"float d = float(0.5lf);", "0.5lf"}, std::pair{"int i = bitCount(3u);", "bitCount"},
        std::pair{"float a = fma(tap.z1, 2.0f, 1.0f);", "fma"}, std::pair{"float a = ldexp(tap.z1, 2);", "ldexp"},
        std::pair{"double d = 1.0;", "double"}}) {
    const std::string file = fmt::format("{} {{\n  {}\n  return true; }}\n", kUserHead, code);
    const std::string said = refusal(file, Language::GlslEs);
    EXPECT_TRUE(said.starts_with(fmt::format("mine.glsl:2: GLSL ES 3.00 has no {}; ", word))) << said;
    EXPECT_EQ(refusal(file), "") << code;
  }
  EXPECT_EQ(refusal(std::string("float fma(float a) { return a; }\n") + kUserHead + " { return fma(1.0f) > tap.z1; }\n",
                    Language::GlslEs),
            "");
}

TEST(ExportOfUserCode, OverloadsAreRefused) {
  const std::string said = refusal(std::string("float f(float a) { return a; }\nfloat f(int a) { return 2.0f; }\n") +
                                   kUserHead + " { return f(1) > tap.z1; }\n");
  EXPECT_EQ(said, "mine.glsl:2: f is defined twice; exported code has no overloads, rename one");
}

// What is refused in some languages by the line of a body, and goes through as GLSL.
void expectRefused(const std::string& before, const std::string& line, const std::vector<Language>& languages,
                   const std::string& what) {
  const std::string file =
      fmt::format("{}{} {{ float x = tap.z1; int n = tap.slice; vec3 v = receiver.posL;\n{}\n  return x > v.y; }}\n",
                  before, kUserHead, line);
  const auto expected = fmt::format("mine.glsl:{}: ", 2 + std::count(before.begin(), before.end(), '\n'));
  for (const Language language : languages) {
    const std::string said = refusal(file, language);
    EXPECT_TRUE(said.starts_with(expected) && mentions(said, what)) << line << ": " << said;
  }
  EXPECT_EQ(refusal(file), "") << line;
}

void expectTaken(const std::string& before, const std::string& line) {
  for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl})
    EXPECT_EQ(refusal(fmt::format("{}{} {{ float x = tap.z1; int n = tap.slice; vec3 v = receiver.posL;\n{}\n  return "
                                  "x > v.y; }}\n",
                                  before, kUserHead, line),
                      language),
              "")
        << line;
}

const std::vector<Language> kCLike = {Language::Hlsl, Language::Msl};

TEST(ExportOfUserCode, ADeclarationOfOneCaseIsNotUsedInAnother) {
  const auto file = [](const char* cases) {
    return fmt::format(
        "{} {{ float x = tap.z1; switch (tap.slice) {{ case 0: float y = x; x = y; break;\n{}\n }}\n return "
        "x > 0.5f; }}\n",
        kUserHead, cases);
  };
  for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl}) {
    for (const char* cases : {"case 1: y = 3.0f; x = y;", "case 1: { float y = 1.0f; x = y; } y = 2.0f; x = y;"}) {
      const std::string said = refusal(file(cases), language);
      EXPECT_TRUE(said.starts_with("mine.glsl:2: y is of another case; declare it before the switch")) << said;
    }
    EXPECT_EQ(refusal(file("case 1: { float y = 1.0f; x = y; } break; default: x = 1.0f;"), language), "");
  }
}

TEST(ExportOfUserCode, AVariableInItsOwnInitializerIsToldByItsLine) {
  expectRefused("", "{ float x = x * 2.0f; v.x = x; }", kCLike, "x in the value that it begins with");
  expectRefused("", "float distance = distance(v, v); v.x = distance;", kCLike,
                "distance beside the function distance");
  expectTaken("float mine(float a) { return a + 1.0f; }\n",
              "float frac = fract(x); float mine = mine(frac); x = mine;");
}

TEST(ExportOfUserCode, WhatMetalsReferencesCannotHoldIsToldByItsLine) {
  const std::string before =
      "struct Mine { float a; float b[2]; vec2 c; };\nvoid inc(inout float a) { a += 1.0f; }\n"
      "void swap(inout float a, out float b) { b = a; a = 0.0f; }\nvoid both(float a, out float b) { b = a; }\n";
  for (const char* line : {"inc(v.y);", "inc(v[1]);", "Mine m; m.c = v.xy; inc(m.c.x); x = m.c.x;"})
    expectRefused(before, line, {Language::Msl}, "a component");
  for (const char* line : {"swap(x, x);", "Mine m; m.b[0] = x; swap(m.b[0], m.b[n]); x = m.b[0];"})
    expectRefused(before, line, {Language::Msl}, "twice");
  expectTaken(before, "Mine m; m.a = x; inc(m.a); m.b[0] = x; inc(m.b[0]); both(m.a, m.b[0]); both(x, x); x = m.b[0];");
}

TEST(ExportOfUserCode, AStructuresConstructorIsOnlyOfADeclaration) {
  const std::string before =
      "struct Mine { float a; float b; };\nfloat sum(Mine m) { return m.a + m.b; }\nMine same(Mine m) { return m; }\n";
  for (const char* line : {"x = sum(Mine(x, 2.0f));", "Mine m; m = Mine(x, 2.0f); x = m.a;"})
    expectRefused(before, line, kCLike, "Mine(...) but as what a declaration begins with");
  expectTaken(before, "Mine m = Mine(x, 2.0f); x = sum(same(m));");
}

TEST(ExportOfUserCode, FloatsAndWholeNumbersOfOneCallAreToldForMetal) {
  for (const char* line : {"x = max(x, 0);", "x = clamp(x, 0, 1);", "x = min(1, v.x);", "x = mix(x, 1.0f, 0);",
                           "x = pow(x, 2);", "x = step(0, x);", "x = max(x, n);", "x = sqrt(2);"})
    expectRefused("", line, {Language::Msl}, "0.0f");
  expectTaken("", "n = max(n, 0); x = max(x, 0.0f) + float(abs(n)) + pow(x, 2.0f) + float(clamp(n, 0, 1));");
}

TEST(ExportOfUserCode, WholeSignsAreToldForHlsl) {
  expectRefused("", "n = sign(n); x = float(n);", {Language::Hlsl}, "sign of whole numbers");
}

TEST(ExportOfUserCode, AVariableWithAStructuresNameIsToldByItsLine) {
  const std::string before = "struct Mine { float a; };\n";
  for (const char* code : {"PlaneDepth PlaneDepth = receiverPlaneDepth(map, receiver, tap);", "float Mine = 1.0f;"}) {
    const std::string said = refusal(fmt::format("{}{} {{\n  {}\n  return true; }}\n", before, kUserHead, code));
    EXPECT_TRUE(said.starts_with("mine.glsl:3: ") && mentions(said, "is a structure's name, too; rename it")) << said;
  }
  const std::string said =
      refusal(before + "float f(float Mine) { return Mine; }\n" + kUserHead + " { return f(tap.z1) > 0.5f; }\n");
  EXPECT_TRUE(said.starts_with("mine.glsl:2: ")) << said;
}

TEST(ExportOfUserCode, ParametersMayBeInAndConst) {
  expectTaken(
      "float f(in float a) { return a; }\nfloat g(const float a) { return a; }\nfloat h(const in float a) { return a; "
      "}\n",
      "x = f(x) + g(x) + h(x);");
}

}  // namespace
}  // namespace gnomon
