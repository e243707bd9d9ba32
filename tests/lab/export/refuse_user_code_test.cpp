// What export reads of the file of a user's bias, and that it tells by line what it refuses.
#include "shadow/user_bias.h"
#include "tests/lab/export/refusal.h"

#include <ctime>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using code::Language;
using test::choiceOf;
using test::expectTaken;
using test::kinds;
using test::kUserHead;
using test::mentions;
using test::refusal;

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

// A name is found as fast whether it is the first or the last of many.
TEST(ExportOfUserCode, ManyVariablesAreNoHindrance) {
  std::string declared = "float n0 = 1.0f;";
  for (int i = 1; i < 8000; ++i) declared += fmt::format(" float n{} = 1.0f;", i);
  const auto timeOf = [&](const std::string& name) {
    const std::string file = fmt::format("{} {{ {}\n{} return {} > 0.5f; }}\n", kUserHead, declared,
                                         repeated(fmt::format("{0} = {0};\n", name), 10000), name);
    const std::clock_t begin = std::clock();
    EXPECT_EQ(refusal(file), "");
    return static_cast<double>(std::clock() - begin);
  };
  timeOf("n0");  // Gnomon's own code is read once
  EXPECT_LT(timeOf("n7999"), 2.5 * timeOf("n0"));
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

TEST(ExportOfUserCode, OverloadsAreRefused) {
  const std::string said = refusal(std::string("float f(float a) { return a; }\nfloat f(int a) { return 2.0f; }\n") +
                                   kUserHead + " { return f(1) > tap.z1; }\n");
  EXPECT_EQ(said, "mine.glsl:2: f is defined twice; exported code has no overloads, rename one");
}

// Gnomon's code would call them instead, or they themselves.
TEST(ExportOfUserCode, OverloadsOfBuiltInFunctionsAreRefused) {
  for (const auto& [function, call] :
       {std::pair{"float floor(int a) { float b = float(a); return b * 2.0f; }", "floor(n)"},
        std::pair{"float tanh(vec2 a) { return tanh(a.x) + tanh(a.y); }", "tanh(vec2(x, x))"},
        std::pair{"float asinh(float a, float b) { float c = a * b; return c + a; }", "asinh(asinh(x), x)"}}) {
    const std::string file = fmt::format("\n{}\n{} {{ float x = tap.z1; int n = tap.slice; return {} > 0.5f; }}\n",
                                         function, kUserHead, call);
    for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl}) {
      const std::string said = refusal(file, language);
      EXPECT_TRUE(said.starts_with("mine.glsl:2: ") && mentions(said, " is a built-in function, too")) << said;
    }
  }
  expectTaken("float tanh(float a, float b) { float c = a * b; return c + a; }\n", "x = tanh(x, 2.0f);");
}

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
