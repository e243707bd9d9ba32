// What a fragment may store of itself (shaders/shadow/store_channels.glsl): which triangle of which instance it is of,
// however the slice is drawn: by ranges of an indexed mesh, by pieces of triangles, by bounds. The second depth stands
// in for a channel of numbers, in a copy of the shaders.
#include "base/file.h"
#include "gpu/shader_compiler.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "omni_fixture.h"
#include "tests/base/temporary_folder.h"

namespace gnomon {
namespace {

constexpr float kNothing = 1.0f;                    // what the channel is cleared to
constexpr uint32_t kTrianglesOfAnInstance = 65536;  // a float holds 256 times as many exactly, and a half

// Shaders that store a number in place of the second depth, and of the nearest fragment.
void numberFragments(const std::filesystem::path& folder) {
  const std::filesystem::path shaders = std::filesystem::path(GNOMON_TEST_DIR) / "../../shaders";
  std::filesystem::copy(shaders, folder, std::filesystem::copy_options::recursive);
  std::string text = readFile(folder / "shadow/store_channels.glsl");
  const auto replace = [&](const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
  };
  replace("if (kPass == kPassPeel)", "if (false)");
  replace("storedSecondDepth = drawn.depth;",
          "storedSecondDepth = float(drawn.instance) * 65536.0f + float(drawn.triangle) + 0.5f;");
  writeTextFile(folder / "shadow/store_channels.glsl", text);
  gpu::setShaderDirectory(folder);
}

class DrawnTriangle : public gpu::GpuTest {};

TEST_F(DrawnTriangle, IsTheFirstThatTheTexelsRayHits) {
  const test::TemporaryFolder folder;
  numberFragments(folder.path() / "shaders");
  const std::pair<const Parameterization&, MapOptions> kinds[] = {
      {cubeParameterization(), {kCubeDepth(CubeDepth::Hyperbolic)}},
      {cubeParameterization(), {kCubeDepth(CubeDepth::Radial)}},
      {paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Exact)}},
      {paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Tessellated)}}};
  for (const char* scene : {"atrium", "sheets"}) {
    const test::World world = test::openWorld(device(), findGeneratedScene(scene)->make());
    for (const auto& [kind, options] : kinds) {
      const FittedMap fitted = test::fitWhole(world, kind, 128, options);
      const test::Slices layers =
          test::drawSlices(device(), world, fitted, CullMode::None, glsl::kChannelSecondDepth, SecondLayer::Peel);
      size_t drawn = 0, others = 0;
      for (size_t i = 0; i < layers.z2.size(); ++i) {
        if (layers.z2[i] == kNothing) continue;
        const int side = fitted.map.width, x = static_cast<int>(i) % side, y = static_cast<int>(i) / side % side;
        const auto hit = world.tracer->firstHit(
            test::rayThrough(fitted, static_cast<int>(i) / (side * side), glm::dvec2(x, y) + 0.5));
        const auto number = static_cast<uint32_t>(layers.z2[i]);
        const uint32_t instance = number / kTrianglesOfAnInstance;
        ASSERT_LT(instance, world.buffers.firstTriangles.size());
        const Primitive stored{instance, number % kTrianglesOfAnInstance - world.buffers.firstTriangles[instance]};
        ++drawn;
        others += !hit || !(hit->primitive == stored) ? 1 : 0;
      }
      // At the edges of triangles the rasterizer's grid of 1/256 texel decides otherwise than the ray; a straight piece
      // of an arc is off by up to half a texel, which is 4% of atrium's texels.
      const bool straight = *fitted.shaders.bounds != '\0' && fitted.shaders.rasterizedDepth;
      EXPECT_GT(drawn, layers.z2.size() / 16) << scene << " " << kind.name();
      EXPECT_LT(others, drawn / (straight ? 20 : 500)) << scene << " " << kind.name() << (straight ? ", pieces" : "");
    }
  }
}

}  // namespace
}  // namespace gnomon
