// The visibility shader on cube and paraboloid maps, end to end, against exact rays; and golden pictures.
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "tests/golden_picture.h"
#include "tests/judge/lit_map.h"

#include <cmath>

namespace gnomon {
namespace {

using test::LitMap;

class VisibleOmni : public gpu::GpuTest {};

const Parameterization* const kMaps[] = {&cubeParameterization(), &paraboloidParameterization()};

TEST_F(VisibleOmni, OnSlopeNoneHasPlentyOfAcneAndAdaptiveNone) {
  for (const Parameterization* map : kMaps) {
    LitMap slope(device(), "tilted-planes", *map, 512, {.side = 512});
    const LabelledResult none = slope.judge("none");
    EXPECT_GT(none.labels.count(Label::Acne), slope.lit.receivers().scored / 5) << map->name();
    const LabelledResult adaptive = slope.judge("adaptive");
    // A GPU interpolates depth between corners on a grid of 1/256 texel: the paper's epsilon is less than that.
    EXPECT_LE(adaptive.labels.count(Label::Acne), isLavapipe() ? 0u : slope.lit.receivers().scored / 500)
        << map->name();
    EXPECT_EQ(adaptive.labels.count(Label::Leak), 0u) << map->name();
  }
}

TEST_F(VisibleOmni, NoScoredPixelIsUncoveredAndLabelsAddUp) {
  for (const char* scene : {"corner", "sheets"}) {
    for (const Parameterization* map : kMaps) {
      LitMap around(device(), scene, *map, 128, {.side = 128});
      const size_t scored = around.lit.receivers().scored;
      for (const char* bias : {"slope", "normal-offset", "receiver-plane", "second-depth"}) {
        const LabelledResult result = around.judge(bias);
        size_t sum = 0;
        for (int label = 1; label < kLabelCount; ++label) sum += result.labels.counts[label];
        EXPECT_EQ(sum, scored) << scene << " " << map->name() << " " << bias;
        EXPECT_EQ(result.labels.count(Label::Uncovered), 0u) << scene << " " << map->name();
        EXPECT_GT(result.labels.count(Label::Agree), scored / 2) << scene << " " << bias;
      }
    }
  }
}

// With the seam through the middle of the picture (the plane of the light and the picture's middle holds it),
// pixels that are looked up within two texels of the rim are wrong no more often than others.
TEST_F(VisibleOmni, TheSeamShowsNoMoreBiasErrorThanElsewhere) {
  const Scene scene = findGeneratedScene("corner")->make();
  const glm::dvec3 lightW(scene.lights.front().positionW);
  // The seam's plane holds the light, the crease of the corner and the middle of a wall.
  const glm::dvec3 axisW = glm::cross(glm::dvec3(0.0, 0.0, 2.0) - lightW, glm::dvec3(2.0, 1.5, 0.0) - lightW);
  LitMap corner(device(), "corner", paraboloidParameterization(), 512,
                {.side = 256, .options = {kParaboloidAxisW(glm::normalize(axisW))}});
  for (const char* bias : {"adaptive", "dual"}) {
    const Method method = atDefaults(findBias(bias), corner.seen);
    const LabelledResult result = corner.lit.judge(method);
    const std::vector<glsl::PixelDiagnosis> decided = corner.lit.diagnose(method);
    size_t atSeam = 0, wrongAtSeam = 0, elsewhere = 0, wrongElsewhere = 0;
    for (size_t i = 0; i < decided.size(); ++i) {
      if (corner.lit.receivers().states[i] != PixelState::Scored) continue;
      const glm::dvec2 fromCenter = glm::dvec2(glsl::unpackTexel(decided[i].texel)) + 0.5 - 128.0;
      const bool nearRim = glm::length(fromCenter) > 126.0;
      const Label label = result.labels.labels[i];
      const bool wrong = label == Label::Acne || label == Label::Leak;
      (nearRim ? atSeam : elsewhere) += 1;
      (nearRim ? wrongAtSeam : wrongElsewhere) += wrong ? 1 : 0;
    }
    EXPECT_GT(atSeam, 300u);
    // A share of so few pixels is good to one over its root; three of those are in hand.
    const double expected =
        static_cast<double>(wrongElsewhere) / static_cast<double>(elsewhere) * static_cast<double>(atSeam);
    EXPECT_LE(static_cast<double>(wrongAtSeam), expected + 3.0 * std::sqrt(expected + 1.0)) << bias;
  }
}

TEST_F(VisibleOmni, GoldenPictures) {
  for (const Parameterization* map : kMaps) {
    LitMap contact(device(), "contact", *map, 256, {.side = 128});
    for (const char* bias : {"none", "constant", "dual", "adaptive"})
      test::compareWithGolden(std::string("contact_") + map->name() + "_" + bias, contact.judge(bias).visibility, 256,
                              isLavapipe());
  }
}

}  // namespace
}  // namespace gnomon
