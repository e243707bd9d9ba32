// The exact shadow through a kernel, where it can be said what it must be.
#include "judge/filtered_truth.h"
#include "map_fixture.h"

#include "shared/filter.glsl"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gnomon {
namespace {

class FilteredTruthTest : public gpu::GpuTest {
 protected:
  std::vector<float> filtered(const test::Rendered& r, int kind) {
    const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
    return computeFilteredTruth(*r.tracer, r.light, r.receivers, truth, r.fitted, kind);
  }
};

TEST_F(FilteredTruthTest, WithoutAFilterItIsTheTruth) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 64, CullMode::Solids);
  const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
  const std::vector<float> visibility = filtered(r, glsl::kShadowFilterNone);
  for (size_t i = 0; i < visibility.size(); ++i) {
    if (r.receivers.states[i] != PixelState::Scored) continue;
    ASSERT_EQ(visibility[i], truth.lit[i] != 0 ? 1.0f : 0.0f);
  }
}

// Nothing casts a shadow into the corner: its walls meet, and past a crease the receiver's plane runs behind
// a wall.
TEST_F(FilteredTruthTest, AConcaveCreaseCastsNoShadow) {
  const test::Rendered r = test::render(device(), "corner", spotParameterization(), 128, 37, CullMode::Solids);
  const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
  ASSERT_EQ(truth.litCount, r.receivers.scored);
  size_t inside = 0;
  for (const int kind : {glsl::kShadowFilterBilinear, glsl::kShadowFilterJitter4x4}) {
    const std::vector<float> visibility = filtered(r, kind);
    for (size_t i = 0; i < visibility.size(); ++i) {
      const glm::dvec3& at = r.receivers.samples[i].positionW;
      if (r.receivers.states[i] != PixelState::Scored || std::max({at.x, at.y, at.z}) > 3.0) continue;
      ++inside;
      ASSERT_EQ(visibility[i], 1.0f) << i << " kernel " << kind;
    }
  }
  EXPECT_GT(inside, size_t{4000});
}

// Away from shadow edges by more than the kernel reaches, it is the truth; at them it is between, and its
// mean over the picture is the truth's: a symmetric kernel takes as much as it gives along a straight edge.
TEST_F(FilteredTruthTest, ItSoftensEdgesAndKeepsTheMean) {
  const test::Rendered r = test::render(device(), "lshape", directionalParameterization(), 256, 128, CullMode::Solids);
  const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
  double lit = 0.0;
  for (const uint8_t l : truth.lit) lit += l;
  size_t before = 0;
  for (const int kind : {glsl::kShadowFilterBilinear, glsl::kShadowFilterJitter4x4}) {
    const std::vector<float> visibility = filtered(r, kind);
    double sum = 0.0;
    size_t between = 0;
    for (size_t i = 0; i < visibility.size(); ++i) {
      if (r.receivers.states[i] != PixelState::Scored) continue;
      sum += static_cast<double>(visibility[i]);
      between += visibility[i] > 0.0f && visibility[i] < 1.0f ? 1 : 0;
    }
    EXPECT_NEAR(sum / lit, 1.0, 0.02) << kind;
    EXPECT_GT(between, before + 500) << kind;  // the wider kernel has the wider edge
    before = between;
  }
}

}  // namespace
}  // namespace gnomon
