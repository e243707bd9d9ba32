// A snapped map holds still while the camera moves within a texel: the depth image itself, bit for bit.
#include "tests/shadow/map_fixture.h"
#include "tests/shadow/seen_scene.h"

#include <algorithm>
#include <set>

namespace gnomon {
namespace {

using test::SeenScene;

class SnappingTest : public gpu::GpuTest {
 protected:
  // The depth image of a map fitted to what a camera sees of the long floor, all of it moved by `shiftW`: a
  // camera that moves along a floor takes what it sees of it along.
  std::vector<float> depthImage(const SeenScene& seen, const Parameterization& map, const MapOptions& options,
                                const glm::dvec3& shiftW) {
    std::vector<glm::dvec3> receivers = seen.scored;
    for (glm::dvec3& receiver : receivers) receiver += shiftW;
    glsl::CameraView camera = seen.view;
    camera.eyeW += glm::vec3(shiftW);
    const FittedMap fitted = map.fit({.scene = *seen.scene,
                                      .light = seen.light,
                                      .receiversW = receivers,
                                      .side = 256,
                                      .camera = camera,
                                      .options = options});
    if (!buffers_) buffers_ = createSceneBuffers(device(), *seen.scene);
    MapImage image(device(), fitted, glsl::kChannelDepth);
    const MapRenderer renderer(device());
    gpu::Commands commands(device(), "shadow map");
    renderer.record(commands, *buffers_, image, seen.light, CullMode::Solids);
    commands.submitAndWait();
    return gpu::downloadAs<float>(device(), image.depth());
  }

  // Distinct depth images of eight cameras, side by side within `reach` metres.
  size_t distinctImages(const SeenScene& seen, const Parameterization& map, const MapOptions& options, double reach) {
    std::set<std::vector<float>> images;
    for (int i = 0; i < 8; ++i) images.insert(depthImage(seen, map, options, {0.0, 0.0, reach * i / 8.0}));
    const std::vector<float>& image = *images.begin();
    EXPECT_GT(std::ranges::count_if(image, [](float d) { return d < 1.0f; }), 1000);
    return images.size();
  }

  void expectHoldsStill(const SeenScene& seen, const Parameterization& map) {
    // The side of a texel on the floor, from its density there.
    for (const WindowFit fit : {WindowFit::None, WindowFit::Tight, WindowFit::Focused}) {
      const FittedMap fitted = seen.fit(map, {kWindowFit(fit)});
      const glsl::Ray a = glsl::mapTexelRay(fitted.map, 0, {0.5f, 0.5f});
      const glsl::Ray b = glsl::mapTexelRay(fitted.map, 0, {0.5f, 0.5f + 1.0f / 256.0f});
      const float reach = fitted.zFar - fitted.zNear;
      const double texel = static_cast<double>(glm::length((a.origin + a.dir * reach) - (b.origin + b.dir * reach)));
      // A step along the floor moves the window's two sides by at most that in each axis: at most one crossing each.
      const size_t snapped = distinctImages(seen, map, {kWindowFit(fit)}, texel);
      EXPECT_LE(snapped, 3u) << map.name() << " " << kWindowFit.text(fit);
      if (fit != WindowFit::None) {  // the whole scene does not move with the camera
        EXPECT_EQ(distinctImages(seen, map, {kWindowFit(fit), kSnap(false)}, texel), 8u)
            << map.name() << " " << kWindowFit.text(fit);
      }
    }
  }

 private:
  std::optional<SceneBuffers> buffers_;
};

TEST_F(SnappingTest, ASunsMapIsTheSameWithinATexel) {
  expectHoldsStill(test::see(test::longFloor(), test::alongTheFloor(), test::sun(50.0, 60.0), 64),
                   directionalParameterization());
}

TEST_F(SnappingTest, ASpotsMapIsTheSameWithinATexel) {
  const LightModel spot{.type = LightType::Spot,
                        .positionW = {12.0, 30.0, 40.0},
                        .directionW = glm::normalize(glm::dvec3(-12.0, -30.0, -5.0)),
                        .outerConeRad = 1.0};
  expectHoldsStill(test::see(test::longFloor(), test::alongTheFloor(), spot, 64), spotParameterization());
}

TEST_F(SnappingTest, EveryCascadeIsTheSameWithinATexel) {
  const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), test::sun(50.0, 60.0), 64);
  const FittedMap fitted = seen.fit(directionalParameterization(), {kCascades(3)});
  const glsl::Ray a = glsl::mapTexelRay(fitted.map, 0, {0.5f, 0.5f});
  const glsl::Ray b = glsl::mapTexelRay(fitted.map, 0, {0.5f, 0.5f + 1.0f / 256.0f});
  // The finest slice's texel; each slice crosses at most once in each axis within it.
  const auto texel = static_cast<double>(glm::length(a.origin - b.origin));
  EXPECT_LE(distinctImages(seen, directionalParameterization(), {kCascades(3)}, 0.5 * texel), 4u);
  EXPECT_EQ(distinctImages(seen, directionalParameterization(), {kSnap(false), kCascades(3)}, 0.5 * texel), 8u);
}

}  // namespace
}  // namespace gnomon
