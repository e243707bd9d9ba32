// The visibility shader on cube and paraboloid maps, end to end, against exact rays; and golden pictures.
#include "base/image.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "tests/golden_picture.h"
#include "tests/shadow/map_fixture.h"
#include "truth/labels.h"

#include "omni_fixture.h"

#include <cmath>
#include <cstdlib>

namespace gnomon {
namespace {

struct Scored {
  LabelImage labels;
  std::vector<float> visibility;
  std::vector<uint32_t> texels;  // that decided each pixel
};

// The paraboloid with its seam where the test wants it.
class AxisParaboloid final : public Parameterization {
 public:
  explicit AxisParaboloid(const glm::dvec3& axisW) : axisW_(glm::normalize(axisW)) {}
  const char* name() const override { return "paraboloid with an axis"; }
  const char* sentence() const override { return paraboloidParameterization().sentence(); }
  int layerCount(const MapOptions& options) const override { return paraboloidParameterization().layerCount(options); }
  Takes takes(LightType type) const override { return paraboloidParameterization().takes(type); }
  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return paraboloidParameterization().lightModel(light, aimW);
  }
  FittedMap fit(const FitInput& input) const override {
    return paraboloidParameterization().fit({.scene = input.scene,
                                             .light = input.light,
                                             .receiversW = input.receiversW,
                                             .side = input.side,
                                             .camera = input.camera,
                                             .options = {.paraboloidAxisW = axisW_}});
  }

 private:
  glm::dvec3 axisW_;
};

class VisibleOmni : public gpu::GpuTest {
 protected:
  Scored score(const test::Rendered& r, const BiasMethod& method) {
    const auto image = test::draw(device(), r, method.content, CullMode::Solids);
    VisibilityPass pass(device(), r.view.width, r.view.height);
    pass.setUniforms(shadeUniforms(r.view, r.light, defaultBiasParams(r.fitted.map.sceneScale)));
    gpu::Commands commands(device(), "visibility");
    pass.record(commands, r.buffers, *r.gbuffer, *image, method, true);
    commands.submitAndWait();
    const auto diagnosis = gpu::downloadAs<glsl::PixelDiagnosis>(device(), pass.diagnosis());
    const Truth truth = computeTruth(*r.tracer, r.light, r.receivers);
    std::vector<Verdict> verdicts(diagnosis.size(), Verdict::NotAsked);
    for (size_t i = 0; i < verdicts.size(); ++i) {
      const uint32_t flags = diagnosis[i].flags;
      if (r.receivers.states[i] != PixelState::Scored) continue;
      if ((flags & glsl::kPixelShaded) == 0)  // edge-on within rounding
        verdicts[i] = truth.lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
      else
        verdicts[i] = (flags & glsl::kPixelCovered) == 0 ? Verdict::Uncovered
                      : (flags & glsl::kPixelLit) != 0   ? Verdict::Lit
                                                         : Verdict::Shadow;
    }
    Scored result;
    result.labels = labelPixels(*r.tracer, r.light, r.receivers, truth, verdicts, [&](size_t pixel) {
      const uint32_t word = diagnosis[pixel].texel;
      return test::rayThrough(r.fitted, glsl::unpackLayer(word), glm::dvec2(glsl::unpackTexel(word)) + 0.5);
    });
    for (const glsl::PixelDiagnosis& pixel : diagnosis) result.texels.push_back(pixel.texel);
    result.visibility = gpu::downloadAs<float>(device(), pass.visibility());
    return result;
  }
};

const Parameterization* const kMaps[] = {&cubeParameterization(), &paraboloidParameterization()};

TEST_F(VisibleOmni, OnSlopeNoneHasPlentyOfAcneAndAdaptiveNone) {
  for (const Parameterization* map : kMaps) {
    const test::Rendered r = test::render(device(), "slope", *map, 512, 512, CullMode::Solids);
    const Scored none = score(r, findBias("none"));
    EXPECT_GT(none.labels.count(Label::Acne), r.receivers.scored / 5) << map->name();
    const Scored adaptive = score(r, findBias("adaptive"));
    EXPECT_EQ(adaptive.labels.count(Label::Acne), 0u) << map->name();
    EXPECT_EQ(adaptive.labels.count(Label::Leak), 0u) << map->name();
  }
}

TEST_F(VisibleOmni, NoScoredPixelIsUncoveredAndLabelsAddUp) {
  for (const char* scene : {"corner", "sheets"}) {
    for (const Parameterization* map : kMaps) {
      const test::Rendered r = test::render(device(), scene, *map, 128, 128, CullMode::Solids);
      for (const char* bias : {"slope", "normal-offset", "receiver-plane", "second-depth"}) {
        const Scored result = score(r, findBias(bias));
        size_t sum = 0;
        for (int label = 1; label < kLabelCount; ++label) sum += result.labels.counts[label];
        EXPECT_EQ(sum, r.receivers.scored) << scene << " " << map->name() << " " << bias;
        EXPECT_EQ(result.labels.count(Label::Uncovered), 0u) << scene << " " << map->name();
        EXPECT_GT(result.labels.count(Label::Agree), r.receivers.scored / 2) << scene << " " << bias;
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
  const AxisParaboloid map(glm::cross(glm::dvec3(0.0, 0.0, 2.0) - lightW, glm::dvec3(2.0, 1.5, 0.0) - lightW));
  const test::Rendered r = test::render(device(), "corner", map, 512, 256, CullMode::Solids);
  for (const char* bias : {"adaptive", "dual"}) {
    const Scored result = score(r, findBias(bias));
    size_t atSeam = 0, wrongAtSeam = 0, elsewhere = 0, wrongElsewhere = 0;
    for (size_t i = 0; i < result.texels.size(); ++i) {
      if (r.receivers.states[i] != PixelState::Scored) continue;
      const glm::dvec2 fromCenter = glm::dvec2(glsl::unpackTexel(result.texels[i])) + 0.5 - 128.0;
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
    const test::Rendered r = test::render(device(), "contact", *map, 256, 128, CullMode::Solids);
    for (const char* bias : {"none", "constant", "dual", "adaptive"})
      test::compareWithGolden(std::string("contact_") + map->name() + "_" + bias, score(r, findBias(bias)).visibility,
                              256, isLavapipe());
  }
}

}  // namespace
}  // namespace gnomon
