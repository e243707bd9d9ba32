// Weiskopf and Ertl, "Shadow Mapping Based on Dual Depth Layers", 2003, figure 5, in counts: an L-shaped
// block under a directional light, on a heavily undersampled map.
#include "lab/compare/compare.h"
#include "lab/core/maps.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

struct Counts {
  size_t acne = 0, leak = 0;
};

class Figure5 : public ::testing::Test {
 protected:
  Counts count(const char* bias, CullMode cull, float offset) {
    CompareOptions options;
    options.maps = parseMaps("directional");
    options.biases = parseBiases(bias);
    options.mapSide = 96;
    options.cull = cull;
    options.repeats = 1;
    for (const Knob& knob : options.biases.front()->knobs) options.knobs.push_back({&knob, offset});
    const Row row = compare(session_, options).rows.front();
    return {row.acne, row.leak};
  }

  const Session session_{{.validation = true}, {.scene = "lshape", .size = "512"}};
  // 0.08 m is about a texel (0.12 m) times the slope of the light: enough for every lit plane.
  static constexpr float kOffset = 0.08f;
};

TEST_F(Figure5, BToF) {
  const Counts b = count("midpoint", CullMode::None, 0.0f);
  EXPECT_GT(b.acne, 50u);   // self-shadowing at silhouettes
  EXPECT_GT(b.leak, 100u);  // self-unshadowing at the crease
  const Counts c = count("dual", CullMode::None, kOffset);
  EXPECT_EQ(c.acne, b.acne);       // the same self-shadowing
  EXPECT_LT(c.leak, b.leak / 50);  // and no self-unshadowing
  const Counts d = count("constant", CullMode::Solids, 2.0f);
  EXPECT_GT(d.leak, 10 * b.leak);  // a large constant leaks at the crease
  const Counts e = count("midpoint", CullMode::Solids, 0.0f);
  EXPECT_LT(e.acne, b.acne / 20);  // culling removes the self-shadowing
  EXPECT_GT(e.leak, b.leak);       // and adds self-unshadowing near silhouettes
  const Counts f = count("dual", CullMode::Solids, kOffset);
  EXPECT_LT(f.acne + f.leak, b.acne / 20);  // neither
}

}  // namespace
}  // namespace gnomon
