// A cube's six faces in one pass: the same as six passes, or refused.
#include "base/error.h"
#include "omni_fixture.h"

#include <algorithm>

namespace gnomon {
namespace {

using test::Slices;
using test::World;

class CubePasses : public gpu::GpuTest {
 protected:
  Slices draw(const World& world, CubeDepth depth, SlicePasses passes, ChannelSet channels, CullMode cull,
              SecondLayer method = SecondLayer::Blend) {
    const FittedMap fitted =
        test::fitWhole(world, cubeParameterization(), 96, {kCubeDepth(depth), kCubePasses(passes)});
    return test::drawSlices(device(), world, fitted, cull, channels, method);
  }
};

TEST_F(CubePasses, OnePassGivesTheLayersOfSixOrIsRefusedByName) {
  size_t refused = 0, equal = 0;
  for (const char* scene : {"contact", "sheets", "atrium"}) {
    const World world = test::openWorld(device(), findGeneratedScene(scene)->make());
    for (const CubeDepth depth : {CubeDepth::Hyperbolic, CubeDepth::Radial}) {
      for (const SecondLayer method : {SecondLayer::Blend, SecondLayer::Peel}) {
        const auto drawBy = [&](SlicePasses passes) {
          return draw(world, depth, passes, glsl::kChannelSecondDepth, CullMode::Solids, method);
        };
        const Slices six = drawBy(SlicePasses::Each);
        const Slices chosen = drawBy(SlicePasses::Auto);
        EXPECT_EQ(chosen.z1, six.z1) << scene;
        EXPECT_EQ(chosen.z2, six.z2) << scene;
        try {
          const Slices one = drawBy(SlicePasses::Multiview);
          EXPECT_EQ(one.z1, six.z1) << scene;
          EXPECT_EQ(one.z2, six.z2) << scene;
          ++equal;
        } catch (const WorldError& error) {
          EXPECT_NE(std::string(error.what()).find(device().info().name), std::string::npos);
          ++refused;
        }
      }
    }
  }
  // A device is right or wrong, and not by turns.
  EXPECT_TRUE((equal == 12 && refused == 0) || (equal == 0 && refused == 12))
      << equal << " equal, " << refused << " refused";
}

// With something else in place of both ways to draw.
TEST_F(CubePasses, TheCheckSeesWhatDiffersAndWhatIsFaster) {
  const World world = test::openWorld(device(), findGeneratedScene("contact")->make());
  const FittedMap fitted = test::fitWhole(world, cubeParameterization(), 64);
  const auto fill = [&](MapImage& map, float depth, std::optional<uint32_t> slice) {
    gpu::Commands commands(device(), "fill");
    for (uint32_t i = 0; i < 6; ++i) {
      commands.beginRendering({.depth = &map.depth(), .clearDepth = slice && *slice == i ? 0.25f : depth, .layer = i});
      commands.endRendering();
    }
    commands.submitAndWait();
  };
  const auto check = [&](std::optional<uint32_t> wrongSlice, double eachMs, double multiviewMs, float depth) {
    return checkMultiview(device(), fitted, [&](const SceneBuffers&, MapImage& map, bool multiview) {
      fill(map, depth, multiview ? wrongSlice : std::nullopt);
      return multiview ? multiviewMs : eachMs;
    });
  };
  EXPECT_TRUE(check({}, 2.0, 1.0, 0.5f).same);
  EXPECT_TRUE(check({}, 2.0, 1.0, 0.5f).faster);
  EXPECT_FALSE(check({}, 1.0, 2.0, 0.5f).faster);
  for (uint32_t slice = 0; slice < 6; ++slice) EXPECT_FALSE(check(slice, 2.0, 1.0, 0.5f).same) << slice;
  EXPECT_FALSE(check({}, 2.0, 1.0, 1.0f).same);  // nothing is drawn: nothing was compared
}

}  // namespace
}  // namespace gnomon
