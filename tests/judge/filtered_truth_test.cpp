// The exact shadow through a kernel, where it can be said what it must be.
#include "lit_map.h"
#include "planar/planar_map.h"

#include "shared/filter.glsl"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gnomon {
namespace {

using test::LitMap;

class FilteredTruthTest : public gpu::GpuTest {};

TEST_F(FilteredTruthTest, WithoutAFilterItIsTheTruth) {
  const LitMap contact(device(), "contact", spotParameterization(), 128, {.side = 64});
  const Receivers& receivers = contact.lit.receivers();
  const Truth& truth = contact.lit.truth();
  const std::vector<float> visibility = contact.lit.filteredTruth(glsl::kShadowFilterNone);
  for (size_t i = 0; i < visibility.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    ASSERT_EQ(visibility[i], truth.lit[i] != 0 ? 1.0f : 0.0f);
  }
}

// Nothing casts a shadow into the corner: its walls meet, and past a crease the receiver's plane runs behind a wall.
TEST_F(FilteredTruthTest, AConcaveCreaseCastsNoShadow) {
  const LitMap corner(device(), "corner", spotParameterization(), 128, {.side = 37});
  const Receivers& receivers = corner.lit.receivers();
  ASSERT_EQ(corner.lit.truth().litCount, receivers.scored);
  size_t inside = 0;
  for (const int kind : {glsl::kShadowFilterBilinear, glsl::kShadowFilterJitter4x4}) {
    const std::vector<float> visibility = corner.lit.filteredTruth(kind);
    for (size_t i = 0; i < visibility.size(); ++i) {
      const glm::dvec3& at = receivers.samples[i].positionW;
      if (receivers.states[i] != PixelState::Scored || std::max({at.x, at.y, at.z}) > 3.0) continue;
      ++inside;
      ASSERT_EQ(visibility[i], 1.0f) << i << " kernel " << kind;
    }
  }
  EXPECT_GT(inside, size_t{4000});
}

// Away from shadow edges by more than the kernel reaches, it is the truth; at them it is between, and its
// mean over the picture is the truth's: a symmetric kernel takes as much as it gives along a straight edge.
TEST_F(FilteredTruthTest, ItSoftensEdgesAndKeepsTheMean) {
  const LitMap block(device(), "lshape", directionalParameterization(), 256, {.side = 128});
  const Receivers& receivers = block.lit.receivers();
  const Truth& truth = block.lit.truth();
  double lit = 0.0;
  for (const uint8_t l : truth.lit) lit += l;
  size_t before = 0;
  for (const int kind : {glsl::kShadowFilterBilinear, glsl::kShadowFilterJitter4x4}) {
    const std::vector<float> visibility = block.lit.filteredTruth(kind);
    double sum = 0.0;
    size_t between = 0;
    for (size_t i = 0; i < visibility.size(); ++i) {
      if (receivers.states[i] != PixelState::Scored) continue;
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
