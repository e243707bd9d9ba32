// The visibility shader end to end, against exact rays: scenes with a known answer, and one golden picture a method.
#include "map_fixture.h"
#include "tests/base/scenes_to_test.h"
#include "tests/golden_picture.h"
#include "tests/judge/lit_map.h"

#include <algorithm>

namespace gnomon {
namespace {

using test::LitMap;

class VisibilityPassTest : public gpu::GpuTest {};

TEST_F(VisibilityPassTest, OnSlopeNoneHasPlentyOfAcneAndAdaptiveNone) {
  for (const Parameterization* map : planarParameterizations()) {
    LitMap slope(device(), "tilted-planes", *map, 512, {.side = 512});
    const LabelledResult none = slope.judge("none");
    EXPECT_GT(none.labels.count(Label::Acne), slope.lit.receivers().scored / 5) << map->name();
    const LabelledResult adaptive = slope.judge("adaptive");
    EXPECT_EQ(adaptive.labels.count(Label::Acne), 0u) << map->name();
    EXPECT_EQ(adaptive.labels.count(Label::Leak), 0u) << map->name();
  }
}

TEST_F(VisibilityPassTest, LabelsAddUpToTheScoredPixelsOnEveryScene) {
  for (const char* scene : test::scenesToTest({"contact", "corner", "lshape", "sheets"})) {
    LitMap spot(device(), scene, spotParameterization(), 128, {.side = 128});
    for (const BiasMethod& method : biasMethods()) {
      const LabelledResult result = spot.judge(method);
      size_t sum = 0;
      for (int label = 1; label < kLabelCount; ++label) sum += result.labels.counts[label];
      EXPECT_EQ(sum, spot.lit.receivers().scored) << scene << " " << method.name;
      EXPECT_EQ(result.labels.count(Label::Uncovered), 0u) << scene;  // the window is fitted to what is scored
    }
  }
}

// Nothing but the floor and two walls, lit from inside the corner: whatever is dark is acne, at the creases,
// and never an edge.
TEST_F(VisibilityPassTest, TheConcaveCornerHasAcneAndNoEdges) {
  size_t acne = 0;
  for (const int mapSide : {24, 29, 37}) {
    LitMap corner(device(), "corner", spotParameterization(), 256, {.side = mapSide});
    const LabelledResult result = corner.judge("adaptive");
    EXPECT_EQ(result.labels.count(Label::EdgeShadow), 0u) << mapSide;
    EXPECT_EQ(result.labels.count(Label::EdgeLight), 0u) << mapSide;
    acne += result.labels.count(Label::Acne);
  }
  EXPECT_GT(acne, 0u);
}

TEST_F(VisibilityPassTest, AnUnknownMethodIsMarkedForMagenta) {
  LitMap spot(device(), "contact", spotParameterization(), 64, {.side = 64});
  const BiasMethod unknown{.id = 999, .name = "none of them"};
  const auto marked = std::ranges::count(spot.judge(unknown).visibility, glsl::kUnknownVisibility);
  EXPECT_GT(marked, 100);
}

TEST_F(VisibilityPassTest, GoldenPictures) {
  // A point light, made to shine as the fixture of this folder has it.
  LitMap contact(device(), "contact", spotParameterization(), 256, {.side = 128});
  const LightModel aimed = test::render(device(), "contact", spotParameterization(), 256, 128, CullMode::Solids).light;
  LightOnMap spot(contact.seen, contact.passes, spotParameterization(), contact.lit.source(), aimed, {.side = 128});
  for (const BiasMethod& method : biasMethods())
    test::compareWithGolden(std::string("contact_spot_") + method.name,
                            spot.judge(atDefaults(method, contact.seen)).visibility, 256, isLavapipe());
  LitMap sun(device(), "lshape", directionalParameterization(), 256, {.side = 64});
  for (const BiasMethod& method : biasMethods())
    test::compareWithGolden(std::string("lshape_directional_") + method.name, sun.judge(method).visibility, 256,
                            isLavapipe());
}

}  // namespace
}  // namespace gnomon
