// What HLSL, Metal or GLSL ES lack of a user's bias, or would take for something else: told by its line there, and
// exported as GLSL.
#include "lab/export/expressions.h"
#include "lab/export/visibility_source.h"
#include "shadow/user_bias.h"
#include "tests/lab/export/refusal.h"

#include <ctime>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using code::Language;
using test::choiceOf;
using test::expectRefused;
using test::expectTaken;
using test::kinds;
using test::kUserHead;
using test::mentions;
using test::refusal;

const std::vector<Language> kCLike = {Language::Hlsl, Language::Msl};

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
  expectTaken("struct dmatch { float a; };\n", "dmatch m; m.a = x; x = m.a;");
  EXPECT_EQ(refusal(std::string("float fma(float a) { return a; }\n") + kUserHead + " { return fma(1.0f) > tap.z1; }\n",
                    Language::GlslEs),
            "");
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
  for (const char* call : {"swap(w[n], w[0]);", "swap(w[0], w[n + 1]);", "swap(w[n], w[n]);"})
    expectRefused(before, fmt::format("float w[2]; w[0] = w[1] = x; {} x = w[0];", call), {Language::Msl},
                  "what may be one element twice as an out argument of swap");
  for (const char* call :
       {"swap(w[1].a, w[1].a);", "swap(w[1].a, (w[0x1u]).a);", "swap(w[n].a, w[n].a);", "swap(w[1].b[n], w[1].b[0]);"})
    expectRefused(before, fmt::format("Mine w[2]; w[0].a = w[1].a = x; {} x = w[0].a;", call), {Language::Msl},
                  mentions(call, "n") ? "may be one element twice" : "one variable twice");
  expectTaken(before, "float w[2]; w[0] = w[1] = x; swap(w[0], w[1]); swap(w[1u], w[0]); x = w[0];");
  expectTaken(before,
              "Mine w[2]; w[0].b[n] = w[1].a = x; swap(w[0].b[n], w[1].b[n]); swap(w[n].a, w[n].b[0]); "
              "swap(w[0].b[0], w[0].b[1]); x = w[0].a;");
  expectTaken(before, "Mine m; m.a = x; inc(m.a); m.b[0] = x; inc(m.b[0]); both(m.a, m.b[0]); both(x, x); x = m.b[0];");
}

TEST(ExportOfUserCode, AStructuresConstructorIsOnlyOfADeclaration) {
  const std::string before =
      "struct Mine { float a; float b; };\nfloat sum(Mine m) { return m.a + m.b; }\nMine same(Mine m) { return m; }\n";
  for (const char* line : {"x = sum(Mine(x, 2.0f));", "Mine m; m = Mine(x, 2.0f); x = m.a;"})
    expectRefused(before, line, kCLike, "Mine(...) but as what a declaration begins with");
  expectTaken(before, "Mine m = Mine(x, 2.0f); x = sum(same(m));");
}

TEST(ExportOfUserCode, AStructuresNumbersAreOfItsTypesInMetal) {
  const std::string before = "struct Mine { int i, k; float a; };\n";
  for (const char* line : {"Mine m = Mine(n, 1, n); x = m.a;", "Mine m = Mine(1, n, n + 1); x = m.a;"})
    expectRefused(before, line, {Language::Msl}, "int as the float a of Mine");
  expectTaken(before, "Mine m = Mine(n, n + 1, float(n)); Mine k = Mine(1, 2, 3); x = m.a + k.a;");
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

TEST(ExportOfUserCode, NumbersOfMoreThan31BitsAreToldByTheirLine) {
  for (const char* line :
       {"x = float(0xFFFFFFFF);", "n = 0x80000000 >> 31; x = float(n);", "x = float(4294967295);", "n = 037777777777;"})
    expectRefused("", line, kCLike, "of more than 31 bits");
  expectTaken("", "n = int(0xFFFFFFFFu) + 0x7FFFFFFF + 2147483647; x = float(n) + 1e30f;");
}

TEST(ExportOfUserCode, TheLowestBitIsAnInt) {
  for (const char* line : {"if (findLSB(uint(n)) < 0) x = 1.0f;", "x = float(findLSB(uint(n)));",
                           "n = max(findLSB(uint(n)), 0);", "x = findLSB(uint(n));"})
    expectRefused("", line, {Language::Hlsl}, "write int(findLSB(...))");
  expectTaken("", "int i = findLSB(uint(n)); n = (findLSB(uint(n))); x = float(i) + float(int(findLSB(uint(n))));");
  for (const char* line : {"n = findLSB(n);", "ivec2 i = findLSB(uvec2(3u, 4u)); n = i.x;"})
    expectRefused("", line, {Language::GlslEs}, "GLSL ES 3.00 has no findLSB but of one uint");
}

// By 0 or 1 a NaN that is not chosen is the result.
TEST(ExportOfUserCode, MixByABoolIsToldByItsLine) {
  for (const char* line : {"x = mix(x, 1.0f, isnan(x));", "x = mix(x, 1.0f, n > 0);", "v = mix(v, v.yzx, isinf(v));"})
    expectRefused("", line, kCLike, "mix by true or false");
  expectRefused("", "n = mix(n, 16777217, x > 0.0f);", {Language::GlslEs, Language::Hlsl}, "mix");
  expectTaken("", "x = isnan(x) ? 1.0f : x; x = mix(x, 1.0f, v.x);");
}

TEST(ExportOfUserCode, LettersOfTexturesAreToldByTheirLine) {
  expectRefused("", "x = v.s;", kCLike, ".s of a vector");
  expectRefused("", "x = v.tp.y;", kCLike, ".tp of a vector");
  expectTaken("struct Mine { float s; };\n", "Mine m; m.s = v.r; x = m.s + v.rgb.b;");
}

TEST(ExportOfUserCode, MoreNumbersThanAVectorHoldsAreToldByTheirLine) {
  for (const char* line :
       {"ivec2 i = ivec2(v); x = float(i.x);", "x = float(v);", "vec3 w = vec3(v.xy, v.xy); x = w.x;"})
    expectRefused("", line, kCLike, "write .x, .xy or .xyz behind the last");
  expectTaken("", "ivec2 i = ivec2(v.xy); x = float(i.x) + float(v.x); vec4 w = vec4(v.xy, v.yx); x += w.x;");
}

TEST(ExportOfUserCode, AFunctionsNameIsNoVariablesWhereItChanges) {
  for (const char* line : {"float inversesqrt = inversesqrt(x); x = inversesqrt;",
                           "{ float inversesqrt = 2.0f; x = inversesqrt; } x = inversesqrt(x);"})
    expectRefused("", line, kCLike, "a variable inversesqrt beside the function inversesqrt");
  expectRefused("", "{ float fract = 2.0f; x = fract; } x = fract(x);", {Language::Hlsl}, "rename it");
  expectTaken("", "{ float abs = 2.0f; x = abs; } x = abs(x);");
}

TEST(ExportOfUserCode, ArraysAreNoValuesInMetal) {
  for (const char* line : {"float a[2], b[2]; a[0] = a[1] = x; b = a; x = b[1];",
                           "float a[2]; a[0] = a[1] = x; float b[2] = a; x = b[1];"})
    expectRefused("", line, {Language::Msl}, "an array assigned as a whole");
  expectTaken("struct Mine { float a[2]; };\n", "Mine m; m.a[0] = m.a[1] = x; Mine k = m; m = k; x = m.a[1];");
}

TEST(ExportOfUserCode, WhatMetalsFunctionsDoNotTakeIsToldByItsLine) {
  EXPECT_TRUE(refusal(std::string("const float kRoot = sqrt(2.0f);\n") + kUserHead + " { return tap.z1 > kRoot; }\n",
                      Language::Msl)
                  .starts_with("mine.glsl:1: sqrt in the value of the constant kRoot"));
  for (const auto& [line, what] :
       {std::pair{"x = length(x);", "length of a number"}, std::pair{"x = dot(x, 2.0f);", "dot of a number"},
        std::pair{"n = sign(n);", "sign of whole numbers"}, std::pair{"x = float(max(1u, n));", "max of int and uint"},
        std::pair{"uvec2 u = uvec2(3u, 4u); x = uintBitsToFloat(u.x);", "uintBitsToFloat of a member"},
        std::pair{"uvec3 u = floatBitsToUint(v); x = float(u.x);", "floatBitsToUint of a vector"}})
    expectRefused("", line, {Language::Msl}, what);
  expectTaken("const vec3 kUp = vec3(0.0f, 1.0f, 0.0f);\n",
              "x = dot(v, kUp) + float(max(1u, uint(n))); uint u = floatBitsToUint(x); x = uintBitsToFloat(u);");
}

TEST(ExportOfUserCode, AShiftIsOfTheTypeOfWhatIsShifted) {
  expectTaken("struct Mine { int i; float a; };\n",
              "uint u = 1u; int k = max(n >> 1u, 0); Mine m = Mine(n << u, 1.0f); u = max(u << n, 1u); "
              "x = float(max(k, m.i << u)) + m.a;");
  expectRefused("", "x = float(max(n << 1u, 1u));", {Language::Msl}, "max of int and uint");
}

TEST(ExportOfUserCode, OutArgumentsOfMetalAreOfTheirType) {
  expectRefused("void put(out int a) { a = 1; }\n", "put(x);", {Language::Msl}, "another type than int");
  expectRefused("void put(out float a) { a = 1.0f; }\n", "put((v.x)); x = v.x;", {Language::Msl}, "a component");
  expectTaken("void put(out float a) { a = 1.0f; }\n", "put((x)); float a[2]; put(a[1]); x = a[1];");
}

TEST(ExportOfUserCode, StructuresOfAConditionAreToldForHlsl) {
  expectRefused("struct Mine { float a; };\n", "Mine m, k; m.a = k.a = x; Mine one = x > 0.5f ? m : k; x = one.a;",
                {Language::Hlsl}, "? of structures");
}

// Which FXC refuses.
TEST(ExportOfUserCode, CasesThatFallThroughAreToldForHlsl) {
  const std::string what = "a case that does not end in break or return is not translated to HLSL; end it with break";
  for (const char* cases :
       {"case 0: x = 1.0f; case 1: x = 2.0f; break;", "case 0: { x = 1.0f; } default: x = 2.0f; break;",
        "default: if (x > 0.5f) break; case 1: x = 2.0f;", "case 0: { break; } x = 1.0f; case 1: x = 2.0f;",
        "case 0: switch (n) { case 0: break; } case 1: x = 2.0f;"})
    expectRefused("", fmt::format("switch (n) {{ {} }}", cases), {Language::Hlsl}, what);
  expectRefused("", "for (;;) { if (x > 0.5f) { switch (n) { case 0: x = 1.0f; default: x = 2.0f; } } }",
                {Language::Hlsl}, what);
  EXPECT_TRUE(refusal(fmt::format("{} {{\n  float x = 1.0f;\n  switch (tap.slice) {{\n  case 0:\n    x = tap.z1;\n    "
                                  "break;\n  case 1:\n  case 2:\n    x = 2.0f;\n  default:\n    x = 3.0f;\n  }}\n  "
                                  "return x > 0.5f; }}\n",
                                  kUserHead),
                      Language::Hlsl)
                  .starts_with("mine.glsl:8: " + what));
  expectTaken("",
              "switch (n) { case 0: case 1: x = 1.0f; break; case 2: { x = 2.0f; break; } case 3: { x = 3.0f; } break; "
              "case 4: return true; case 5: { x = 1.0f; { return false; } } case 6: default: x = 4.0f; }");
}

// Not at the price of its length times its length.
TEST(ExportOfUserCode, LongExpressionsAreReadOnce) {
  std::string product = "x", all;
  for (int i = 0; i < 900; ++i) product += "*x";
  for (int i = 0; i < 10; ++i) all += "x = " + product + ";\n";
  const std::string file = fmt::format("{} {{ float x = tap.z1;\n{}  return x > 0.5f; }}\n", kUserHead, all);
  const auto timeOf = [&](Language language) {
    const std::clock_t begin = std::clock();
    EXPECT_EQ(refusal(file, language), "");
    return static_cast<double>(std::clock() - begin);
  };
  timeOf(Language::Glsl);  // Gnomon's own code is read once
  EXPECT_LT(timeOf(Language::Hlsl), 2.5 * timeOf(Language::Glsl));
}

}  // namespace
}  // namespace gnomon
