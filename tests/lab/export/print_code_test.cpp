// Code that says the same in every language, and compiles there.
#include "lab/export/print_code.h"
#include "shadow/user_bias.h"
#include "tests/lab/export/compile_export.h"
#include "tests/lab/export/what_to_export.h"

#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using code::Language;
using test::choiceOf;
using test::compiled;
using test::kinds;
using test::kUserHead;
using test::mentions;
using test::metalErrors;

// A user's file in a language; it is expected to compile there.
std::string exportedOf(const std::string& glsl, Language language) {
  const auto user = readUserBias("mine.glsl", glsl);
  const std::string text = exportShader(choiceOf(kinds()[1], user->method, filters()[0], language)).text;
  EXPECT_EQ(language == Language::Msl ? metalErrors(text) : compiled(language, text), "") << text;
  return text;
}

std::string exportedBody(const std::string& body, Language language) {
  return exportedOf(
      fmt::format("{} {{\n  float x = tap.z1; int n = tap.slice;\n{}\n  return x > 0.5f; }}\n", kUserHead, body),
      language);
}

constexpr Language kLanguages[] = {Language::Glsl, Language::GlslEs, Language::Hlsl, Language::Msl};

TEST(Export, SignsBesideSignsStayTwo) {
  for (const Language language : kLanguages) {
    const std::string text = exportedOf(
        fmt::format(
            "#define NEG -1.0f\n{} {{ float x = tap.z1; float y = - -x; x += + +y; x *= -NEG; x = y - -x; return "
            "- - -x > y; }}\n",
            kUserHead),
        language);
    for (const char* printed : {"- -x", "+ +y", "- -1.0f", "y - -x", "- - -x"})
      EXPECT_TRUE(mentions(text, printed)) << printed;
  }
}

TEST(Export, NoCommentGoesOnBehindABackslash) {
  for (const Language language : kLanguages) {
    const std::string text =
        exportedOf(fmt::format("// head \\ \n\n//! sentence: A folder C:\\ \n// of it \\\t\n{} {{\n  // a folder C:\\ "
                               "\n  float x = tap.z1;  // behind "
                               "\\ \n  if (x > 1.0f) {{  // within \\ \n    x = 1.0f;\n  }}\n  return x > 0.5f; }}\n",
                               kUserHead),
                   language);
    EXPECT_FALSE(std::regex_search(text, std::regex("\\\\[ \t]*\n"))) << text;
    EXPECT_TRUE(mentions(text, "// a folder C:\\"));
  }
}

TEST(Export, CasesKeepWhatTheyHave) {
  for (const Language language : kLanguages) {
    const std::string labels = exportedBody(
        "  switch (n) { case 0: x = 1.0f; break; case 1: default: x = 2.0f; break; }\n"
        "  switch (n) { default: case 3: x += 3.0f; break; }",
        language);
    EXPECT_EQ(std::regex_replace(labels, std::regex("default:\\n *x \\+?= [23]"), "#").find("default:"),
              std::string::npos)
        << labels;
    EXPECT_TRUE(mentions(labels, "default:\n      x = 2.0f;")) << labels;
    EXPECT_TRUE(mentions(labels, "default:\n      x += 3.0f;")) << labels;
    exportedBody(
        "  switch (n) {\n  case 0: { float t = 1.0f; x += t; } { float t = 2.0f; x += t; } break;\n"
        "  case 1: x = 1.0f; { float t = 1.0f; x += t; } break;\n"
        "  case 2: { float t = 1.0f; x += t; } break;\n  case 3: float t = 2.0f; x = t; break;\n  }",
        language);
  }
}

TEST(Export, EmptyStatementsAreNothing) {
  for (const Language language : kLanguages) {
    const std::string text = exportedOf(
        fmt::format(
            "#define TWICE(name) float name(float a) {{ ; return a * 2.0f;; }}\nTWICE(mine);\nconst float kOne = "
            "1.0f;;\nstruct Own {{ float a; }};;\nfloat same(float a) {{ a += kOne;; return a; }};\n;{} {{ ;\n"
            "  float x = mine(tap.z1);; // doubled\n  int n = tap.slice;;; {{ ; }} {{ {{}}; x += 0.5f; }};\n"
            "  if (n > 0) ; else x = 2.0f;\n  if (n > 1) x = 3.0f; else ;\n"
            "  for (int i = 0; i < 3; ++i) ;\n  while (n++ < 3) ;\n"
            "  switch (n) {{ case 0: ; x = 1.0f; break;; case 1: ; default: ; }}\n"
            "  return same(x) > 0.5f;; }};;\n",
            kUserHead),
        language);
    EXPECT_TRUE(mentions(text, "Mine(tap.z1);  // doubled\n")) << text;
    EXPECT_TRUE(mentions(text, "default:\n      break;\n")) << text;
  }
}

// Which HLSL counts as a whole number.
TEST(Export, SignsAreFloats) {
  EXPECT_TRUE(mentions(exportedBody("  x = sign(x) / 2.0f;", Language::Hlsl), "x = (1.0f * sign(x)) / 2.0f;"));
  EXPECT_TRUE(mentions(exportedBody("  x = sign(x) / 2.0f;", Language::Glsl), "x = sign(x) / 2.0f;"));
}

TEST(Export, ShiftsByUnsignedNumbersStayInts) {
  for (const Language language : kLanguages)
    EXPECT_TRUE(mentions(exportedBody("  uint u = 1u; n = max(n >> 1u, 0) + max(1 << u, n);", language),
                         "n = max(n >> 1u, 0) + max(1 << u, n);"));
}

// GLSL's is -1 where there is no bit.
TEST(Export, TheLowestBitOfNoneIsMinusOne) {
  for (const Language language : {Language::GlslEs, Language::Msl})
    EXPECT_TRUE(mentions(exportedBody("  x += float(findLSB(uint(n)));", language), "bits == 0u ? -1 :"));
}

}  // namespace
}  // namespace gnomon
