// What export reads of the file of a user's bias, and that it tells by line what it refuses.
#include "base/error.h"
#include "shadow/user_bias.h"
#include "tests/lab/export/what_to_export.h"

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
        std::pair{"bvec2 b = bvec2(true);", "bvec2"}, std::pair{"vec2 f = vec2(tap.z1);", "vec2 of one value"},
        std::pair{"double d = 1.0;", "double"}, std::pair{"float t = atan(tap.z1, 2.0f);", "atan of two"},
        std::pair{"float d = float(1.0lf);", "1.0lf"}}) {
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
  EXPECT_TRUE(
      mentions(refusal(head + "  return float(params.epsilonAt) > tap.z1; }\n"), "mine.glsl:2: userLit uses its"));
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

}  // namespace
}  // namespace gnomon
