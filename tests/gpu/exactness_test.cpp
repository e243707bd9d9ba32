// Which operations give the same bits in a shader and in C++: the shared mathematics is built on this.
// Operation by operation: Mesa's compiler may gather constants, so that x - 0.5f - y + 1e-7f, which adds two
// of them, differs from C++ by their rounding.
#include "tests/arithmetic.glsl"
#include "tests/run_kernel.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace gnomon::gpu {
namespace {

using namespace glsl;

static_assert(sizeof(ArithmeticInput) == 36);
static_assert(sizeof(ArithmeticOutput) == 68);

constexpr size_t kCount = 4 * kKernelInputCount;

// Either sign, 2^-20 to 2^20: no operation below then meets a denormal, which lavapipe flushes to zero.
float randomFloat(std::mt19937& random) {
  const float mantissa = std::uniform_real_distribution<float>(1.0f, 2.0f)(random);
  const int exponent = std::uniform_int_distribution<int>(-20, 19)(random);
  return std::ldexp(random() & 1u ? mantissa : -mantissa, exponent);
}

vec3 randomVec3(std::mt19937& random) {
  const float x = randomFloat(random);
  const float y = randomFloat(random);
  return vec3(x, y, randomFloat(random));
}

class ExactnessTest : public GpuTest {};

TEST_F(ExactnessTest, ArithmeticHasTheSameBits) {
  std::mt19937 random(14);
  std::vector<ArithmeticInput> inputs(kCount);
  for (ArithmeticInput& input : inputs) {
    input.a = randomVec3(random);
    input.b = randomVec3(random);
    input.x = randomFloat(random);
    input.y = randomFloat(random);
    input.positive = std::abs(randomFloat(random));
  }
  const auto outputs = runKernel<ArithmeticInput, ArithmeticOutput>(
      device(), GNOMON_TEST_SHADER("evaluate_arithmetic.comp.glsl"), inputs);

  struct Operation {
    const char* name;
    int64_t bound;  // ulps
    float ArithmeticOutput::*field;
    int64_t worst = 0;
  };
  const int64_t exact = exactTolerance();
  Operation operations[] = {
      {"+", exact, &ArithmeticOutput::sum},          {"-", exact, &ArithmeticOutput::difference},
      {"*", exact, &ArithmeticOutput::product},      {"/", exact, &ArithmeticOutput::quotient},
      {"sqrt", exact, &ArithmeticOutput::root},      {"inversesqrt", exact, &ArithmeticOutput::inverseRoot},
      {"dot", exact, &ArithmeticOutput::dotProduct}, {"length", exact, &ArithmeticOutput::lengthOfA},
      {"fract", exact, &ArithmeticOutput::fraction}, {"floor", exact, &ArithmeticOutput::whole},
  };
  int64_t worstCross = 0, worstNormalize = 0;
  size_t wrongComparisons = 0;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const ArithmeticOutput expected = computeArithmetic(inputs[i]);
    for (Operation& operation : operations)
      operation.worst = std::max(operation.worst, ulpDistance(outputs[i].*operation.field, expected.*operation.field));
    for (int k = 0; k < 3; ++k) {
      worstCross = std::max(worstCross, ulpDistance(outputs[i].crossProduct[k], expected.crossProduct[k]));
      worstNormalize = std::max(worstNormalize, ulpDistance(outputs[i].unit[k], expected.unit[k]));
    }
    if (outputs[i].less != expected.less) ++wrongComparisons;
  }
  for (const Operation& operation : operations) {
    // A sum of products that cancels has no bound in ulps where they may be fused.
    if (!isLavapipe() && std::string_view(operation.name) == "dot") continue;
    EXPECT_LE(operation.worst, operation.bound) << operation.name;
  }
  EXPECT_EQ(wrongComparisons, 0u);
  if (isLavapipe()) {
    EXPECT_LE(worstCross, exact);
  }
  EXPECT_LE(worstNormalize, 1 + exact);
}

// Not exact, and how far off they are: what the shared mathematics may rely on.
TEST_F(ExactnessTest, TranscendentalsStayWithinTheirMeasuredError) {
  std::mt19937 random(15);
  std::uniform_real_distribution<float> cosine(-1.0f, 1.0f), angle(-8.0f, 8.0f), positive(0.01f, 100.0f);
  std::vector<TranscendentalInput> inputs(kCount);
  for (TranscendentalInput& input : inputs) {
    input.x = randomFloat(random);
    input.y = randomFloat(random);
    input.cosine = cosine(random);
    input.angle = angle(random);
    input.exponent = cosine(random) * 8.0f;
    input.positive = positive(random);
  }
  const auto outputs = runKernel<TranscendentalInput, TranscendentalOutput>(
      device(), GNOMON_TEST_SHADER("evaluate_transcendentals.comp.glsl"), inputs);
  TranscendentalOutput worst{};
  const auto absolute = [](float& most, float a, float b) { most = std::max(most, std::abs(a - b)); };
  const auto relative = [](float& most, float a, float b) { most = std::max(most, std::abs(a - b) / std::abs(b)); };
  for (size_t i = 0; i < inputs.size(); ++i) {
    const TranscendentalOutput expected = computeTranscendentals(inputs[i]);
    absolute(worst.sine, outputs[i].sine, expected.sine);
    absolute(worst.cosine, outputs[i].cosine, expected.cosine);
    absolute(worst.arcTangent, outputs[i].arcTangent, expected.arcTangent);
    absolute(worst.arcCosine, outputs[i].arcCosine, expected.arcCosine);
    relative(worst.exponential, outputs[i].exponential, expected.exponential);
    absolute(worst.logarithm, outputs[i].logarithm, expected.logarithm);
    relative(worst.power, outputs[i].power, expected.power);
  }
  EXPECT_LE(worst.sine, isLavapipe() ? 1.2e-7f : 2e-6f);  // 1.2e-6 on an H200; Vulkan allows 2^-11
  EXPECT_LE(worst.cosine, isLavapipe() ? 1.2e-7f : 2e-6f);
  EXPECT_LE(worst.arcTangent, 4e-6f);
  EXPECT_LE(worst.arcCosine, 2e-4f);
  EXPECT_LE(worst.exponential, 2e-5f);
  EXPECT_LE(worst.logarithm, 2e-5f);
  EXPECT_LE(worst.power, 2e-5f);
}

}  // namespace
}  // namespace gnomon::gpu
