// The visibility shader end to end, against exact rays: scenes with a known answer, and one golden picture a
// method.
#include "base/image.h"
#include "map_fixture.h"
#include "tests/golden_picture.h"
#include "truth/labels.h"

#include <algorithm>
#include <cstdlib>

namespace gnomon {
namespace {

struct Scored {
  LabelImage labels;
  std::vector<float> visibility;
  size_t scored = 0;
};

class VisibilityPassTest : public gpu::GpuTest {
 protected:
  // With the map that the method needs.
  Scored score(const test::Rendered& r, const BiasMethod& method) {
    const auto image = test::draw(device(), r, method.content, CullMode::Solids);
    return score(r, *image, method);
  }

  Scored score(const test::Rendered& r, const MapImage& image, const BiasMethod& method) {
    VisibilityPass pass(device(), r.view.width, r.view.height);
    pass.setUniforms(shadeUniforms(r.view, r.light, defaultBiasParams(r.fitted.map.sceneScale)));
    gpu::Commands commands(device(), "visibility");
    pass.record(commands, r.buffers, *r.gbuffer, image, method, true);
    commands.submitAndWait();
    const auto diagnosis = gpu::downloadAs<glsl::PixelDiagnosis>(device(), pass.diagnosis());
    std::vector<Verdict> verdicts(diagnosis.size(), Verdict::NotAsked);
    for (size_t i = 0; i < verdicts.size(); ++i) {
      const uint32_t flags = diagnosis[i].flags;
      if ((flags & glsl::kPixelShaded) == 0) continue;
      verdicts[i] = (flags & glsl::kPixelCovered) == 0 ? Verdict::Uncovered
                    : (flags & glsl::kPixelLit) != 0   ? Verdict::Lit
                                                       : Verdict::Shadow;
    }
    const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
    const glm::dmat3 worldFromLight(glm::dvec3(r.fitted.frame.rightW), glm::dvec3(r.fitted.frame.upW),
                                    glm::dvec3(r.fitted.frame.backW));
    Scored result;
    result.labels = labelPixels(*r.tracer, r.light, r.receivers, truth, verdicts, [&](size_t pixel) {
      const glm::vec2 uv = glsl::mapTexelCenter(r.fitted.map, glsl::unpackTexel(diagnosis[pixel].texel));
      const glsl::Ray ray = glsl::mapTexelRay(r.fitted.map, 0, uv);
      return RayD{.origin = glm::dvec3(r.fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
                  .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
    });
    result.visibility = gpu::downloadAs<float>(device(), pass.visibility());
    result.scored = r.receivers.scored;
    return result;
  }
};

TEST_F(VisibilityPassTest, OnSlopeNoneHasPlentyOfAcneAndAdaptiveNone) {
  for (const Parameterization* map : planarParameterizations()) {
    const test::Rendered r = test::render(device(), "tilted-planes", *map, 512, 512, CullMode::Solids);
    const Scored none = score(r, findBias("none"));
    EXPECT_GT(none.labels.count(Label::Acne), none.scored / 5) << map->name();
    const Scored adaptive = score(r, findBias("adaptive"));
    EXPECT_EQ(adaptive.labels.count(Label::Acne), 0u) << map->name();
    EXPECT_EQ(adaptive.labels.count(Label::Leak), 0u) << map->name();
  }
}

TEST_F(VisibilityPassTest, LabelsAddUpToTheScoredPixelsOnEveryScene) {
  for (const char* scene : {"contact", "corner", "lshape", "sheets"}) {
    const test::Rendered r = test::render(device(), scene, spotParameterization(), 128, 128, CullMode::Solids);
    for (const BiasMethod& method : biasMethods()) {
      const Scored result = score(r, method);
      size_t sum = 0;
      for (int label = 1; label < kLabelCount; ++label) sum += result.labels.counts[label];
      EXPECT_EQ(sum, r.receivers.scored) << scene << " " << method.name;
      EXPECT_EQ(result.labels.count(Label::Uncovered), 0u) << scene;  // the window is fitted to what is scored
    }
  }
}

// Nothing but the floor and two walls, lit from inside the corner: whatever is dark is acne, at the creases,
// and never an edge.
TEST_F(VisibilityPassTest, TheConcaveCornerHasAcneAndNoEdges) {
  size_t acne = 0;
  for (const int mapSide : {24, 29, 37}) {
    const test::Rendered r = test::render(device(), "corner", spotParameterization(), 256, mapSide, CullMode::Solids);
    const Scored result = score(r, findBias("adaptive"));
    EXPECT_EQ(result.labels.count(Label::EdgeShadow), 0u) << mapSide;
    EXPECT_EQ(result.labels.count(Label::EdgeLight), 0u) << mapSide;
    acne += result.labels.count(Label::Acne);
  }
  EXPECT_GT(acne, 0u);
}

TEST_F(VisibilityPassTest, AnUnknownMethodIsMarkedForMagenta) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 64, 64, CullMode::Solids);
  const Scored result = score(r, *r.image, {.id = 999, .name = "none of them"});
  const auto marked = std::ranges::count(result.visibility, glsl::kUnknownVisibility);
  EXPECT_GT(marked, 100);
}

TEST_F(VisibilityPassTest, GoldenPictures) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 256, 128, CullMode::Solids);
  for (const BiasMethod& method : biasMethods())
    test::compareWithGolden(std::string("contact_spot_") + method.name, score(r, method).visibility, 256, isLavapipe());
  const test::Rendered d = test::render(device(), "lshape", directionalParameterization(), 256, 64, CullMode::Solids);
  for (const BiasMethod& method : biasMethods())
    test::compareWithGolden(std::string("lshape_directional_") + method.name, score(d, method).visibility, 256,
                            isLavapipe());
}

}  // namespace
}  // namespace gnomon
