// Specialization before the driver: what a constant decides is gone from the module, and nothing else is.
#include "gpu/specialize.h"

#include "gpu/program.h"
#include "tests/gpu_fixture.h"

#include <algorithm>

namespace gnomon::gpu {
namespace {

// The opcodes of SPIR-V 1.6 that are asked for.
constexpr uint32_t kOpSpecConstant = 50;
constexpr uint32_t kOpFunction = 54;
constexpr uint32_t kOpSwitch = 251;
constexpr uint32_t kOpExtInst = 12;

// Instructions start after a header of five words; each says how many words it has.
long countOf(const std::vector<uint32_t>& spirv, uint32_t opcode) {
  long count = 0;
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16u)
    if ((spirv[at] & 0xffffu) == opcode) ++count;
  return count;
}

const char* const kChoice =
    "layout(local_size_x = 1) in;\n"
    "layout(constant_id = 3) const int kChoice = 1;\n"
    "layout(constant_id = 4) const int kFactor = 10;\n"
    "layout(scalar, binding = 0) buffer B { float v; };\n"
    "float sine(float x) { return sin(x); }\n"
    "float root(float x) { return sqrt(x); }\n"
    "float chosen(float x) {\n"
    "  switch (kChoice) { case 1: return sine(x); case 2: return root(x); }\n"
    "  return x;\n"
    "}\n"
    "void main() { v = chosen(v) * float(kFactor); }\n";

TEST(Specialize, BranchesNotTakenAndTheirFunctionsAreGone) {
  const std::vector<uint32_t> whole = compileShader(inlineShader("t/choice.comp.glsl", kChoice));
  ASSERT_EQ(countOf(whole, kOpSpecConstant), 2);
  ASSERT_EQ(countOf(whole, kOpFunction), 4);
  ASSERT_EQ(countOf(whole, kOpExtInst), 2);
  const std::vector<uint32_t> root = specialize(whole, {{.id = 3, .value = 2}});
  EXPECT_EQ(countOf(root, kOpSpecConstant), 0);
  EXPECT_EQ(countOf(root, kOpSwitch), 0);
  EXPECT_EQ(countOf(root, kOpFunction), 3);
  EXPECT_EQ(countOf(root, kOpExtInst), 1);
  const std::vector<uint32_t> neither = specialize(whole, {{.id = 3, .value = 7}});
  EXPECT_EQ(countOf(neither, kOpFunction), 2);
  EXPECT_EQ(countOf(neither, kOpExtInst), 0);
}

TEST(Specialize, DefaultsStayAndConstantsOfOtherStagesArePassedOver) {
  const std::vector<uint32_t> whole = compileShader(inlineShader("t/choice.comp.glsl", kChoice));
  EXPECT_EQ(specialize(whole, {{.id = 9, .value = 2}}), specialize(whole, {{.id = 3, .value = 1}}));
  EXPECT_NE(specialize(whole, {}), specialize(whole, {{.id = 4, .value = 11}}));
}

TEST(Specialize, WhatIsOnDiskIsWhatWasMade) {
  const TemporaryFolder folder;
  const char* before = std::getenv("GNOMON_CACHE_DIR");
  const std::string kept = before ? before : "";
  ::setenv("GNOMON_CACHE_DIR", folder.path().c_str(), 1);
  const std::vector<uint32_t> whole = compileShader(inlineShader("t/choice.comp.glsl", kChoice));
  const std::vector<uint32_t> made = specialize(whole, {{.id = 3, .value = 2}});
  EXPECT_EQ(specialize(whole, {{.id = 3, .value = 2}}), made);
  EXPECT_NE(specialize(whole, {{.id = 3, .value = 1}}), made);
  const auto files = std::filesystem::recursive_directory_iterator(folder.path());
  EXPECT_EQ(std::count_if(begin(files), end(files), [](const auto& e) { return e.is_regular_file(); }), 3);
  ::setenv("GNOMON_CACHE_DIR", kept.c_str(), 1);
}

// A pipeline of one bias on one map holds half of the shader that serves all of them.
TEST(Specialize, AVisibilityShaderShrinksToItsBiasAndMap) {
  const std::vector<uint32_t> whole = compileShader({.path = "shadow/shade_visibility.comp.glsl", .overrides = {}});
  const std::vector<uint32_t> one = specialize(whole, {{.id = 0, .value = 3}, {.id = 2, .value = 1}});
  EXPECT_LT(one.size() * 10, whole.size() * 6);
}

}  // namespace
}  // namespace gnomon::gpu
