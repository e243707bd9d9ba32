#pragma once
// Whether export takes a user's file, and what it says where it does not.

#include "base/error.h"
#include "shadow/user_bias.h"
#include "tests/lab/export/what_to_export.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon::test {

// What it says; empty where it is exported.
inline std::string refusal(const std::string& glsl, code::Language language = code::Language::Glsl) {
  try {
    const auto user = readUserBias("mine.glsl", glsl);
    exportShader(choiceOf(kinds()[1], user->method, filters()[0], language));
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

// What is refused in some languages by the line of a body, and goes through as GLSL.
inline void expectRefused(const std::string& before, const std::string& line,
                          const std::vector<code::Language>& languages, const std::string& what) {
  const std::string file =
      fmt::format("{}{} {{ float x = tap.z1; int n = tap.slice; vec3 v = receiver.posL;\n{}\n  return x > v.y; }}\n",
                  before, kUserHead, line);
  const auto expected = fmt::format("mine.glsl:{}: ", 2 + std::count(before.begin(), before.end(), '\n'));
  for (const code::Language language : languages) {
    const std::string said = refusal(file, language);
    EXPECT_TRUE(said.starts_with(expected) && mentions(said, what)) << line << ": " << said;
  }
  EXPECT_EQ(refusal(file), "") << line;
}

inline void expectTaken(const std::string& before, const std::string& line) {
  for (const code::Language language :
       {code::Language::Glsl, code::Language::GlslEs, code::Language::Hlsl, code::Language::Msl})
    EXPECT_EQ(refusal(fmt::format("{}{} {{ float x = tap.z1; int n = tap.slice; vec3 v = receiver.posL;\n{}\n  return "
                                  "x > v.y; }}\n",
                                  before, kUserHead, line),
                      language),
              "")
        << line;
}

}  // namespace gnomon::test
