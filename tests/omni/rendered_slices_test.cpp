// What the slices hold against exact rays through the same texels.
#include "omni/paraboloid_map.h"

#include "omni_fixture.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using test::Slices;
using test::TexelErrors;
using test::World;

// 2^-24: half an ulp of 1.
constexpr double kRound = 5.97e-8;

struct Kind {
  const char* name;
  const Parameterization& map;
  MapOptions options;
};

std::vector<Kind> kinds() {
  return {{"cube", cubeParameterization(), {kCubeDepth(CubeDepth::Hyperbolic)}},
          {"cube, radial", cubeParameterization(), {kCubeDepth(CubeDepth::Radial)}},
          {"paraboloid", paraboloidParameterization(), {}},
          {"paraboloid askew",
           paraboloidParameterization(),
           {kParaboloidAxisW(glm::normalize(glm::dvec3(1.0, 0.3, -0.7)))}}};
}

// And what is not exact.
std::vector<Kind> kindsOfAllRasters() {
  std::vector<Kind> all = kinds();
  all.push_back(
      {"paraboloid tessellated", paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Tessellated)}});
  return all;
}

class RenderedSlices : public gpu::GpuTest {
 protected:
  World open(const char* scene) { return test::openWorld(device(), findGeneratedScene(scene)->make()); }
};

// How far a stored distance may be from the exact one, metres.
//
// A cube's face is rasterized: z (or 1/w) is a + x dz/dx + y dz/dy in floats, and a and the products are as
// large as the plane's change across the whole face, so each rounds by 2^-24 of that, and the gradient, which
// comes of the corners, by as much times the triangle's slenderness (longest edge squared over twice the
// area); 16 more are the transforms of both sides. In metres: divided by the slope of what is interpolated
// along the ray. The texel's direction and the hit's place are rounded too, by a few 2^-24 of the distance
// across the ray, which the surface's slant turns into distance.
double rasterTolerance(const World& world, const FittedMap& fitted, int slice, glm::ivec2 texel,
                       const SurfaceHit& hit) {
  const RayD here = test::rayThrough(fitted, slice, glm::dvec2(texel) + 0.5);
  const glm::dvec3 originW(fitted.frame.originW);
  const glm::dvec3 pointL = here.origin + here.dir * hit.distance - originW;
  // 1/m of the plane n.p = n.point, along the direction (s, t, 1): affine in s and t.
  const auto inverseM = [&](glm::dvec2 place) {
    const glm::dvec3 dir = test::rayThrough(fitted, slice, place).dir;
    const double m = glm::dvec3(glsl::cubeFaceFromLight(slice, glm::vec3(dir))).z;
    return glm::dot(hit.normalW, dir) / (m * glm::dot(hit.normalW, pointL));
  };
  const glm::dvec2 center = glm::dvec2(texel) + 0.5;
  const double change = std::abs(inverseM(center + glm::dvec2(1, 0)) - inverseM(center)) +
                        std::abs(inverseM(center + glm::dvec2(0, 1)) - inverseM(center));
  const double m = glm::dvec3(glsl::cubeFaceFromLight(slice, glm::vec3(pointL))).z;
  glm::dvec3 c[3];
  world.tracer->corners(hit.primitive, c);
  const double longest = std::max({glm::length(c[1] - c[0]), glm::length(c[2] - c[1]), glm::length(c[0] - c[2])});
  const double slenderness = longest * longest / glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
  const double ofInverse = kRound * (16.0 / m + (2.0 + slenderness) * change * fitted.map.width);
  // d distance = m^2 d(1/m) / cos(angle to the axis); the depth itself is stored to 2^-24.
  const double slope = glsl::mapDepthSlope(fitted.map, slice, glm::vec3(pointL), glm::vec3(here.dir));
  const double cosine = std::abs(glm::dot(hit.normalW, here.dir));
  return ofInverse * m * glm::length(pointL) + 4.0 * kRound / slope + 8.0 * kRound * glm::length(pointL) / cosine;
}

// A paraboloid's texel meets the triangle itself: the corners and the texel's ray are rounded by a few 2^-24 of the
// largest distance, which the surface's slant turns into distance; the depth is stored to 2^-24 of its range.
double rayTolerance(const World& world, const FittedMap& fitted, const RayD& ray, const SurfaceHit& hit) {
  glm::dvec3 c[3];
  world.tracer->corners(hit.primitive, c);
  double largest = 0.0;
  for (const glm::dvec3& corner : c) largest = std::max(largest, glm::length(corner - world.light.positionW));
  const double cosine = std::abs(glm::dot(hit.normalW, ray.dir));
  return kRound * (8.0 * largest / cosine + 2.0 * fitted.zFar);
}

double tolerance(const World& world, const FittedMap& fitted, int slice, glm::ivec2 texel, const SurfaceHit& hit) {
  if (fitted.map.kind != glsl::kMapParaboloid) return rasterTolerance(world, fitted, slice, texel, hit);
  return rayTolerance(world, fitted, test::rayThrough(fitted, slice, glm::dvec2(texel) + 0.5), hit);
}

TEST_F(RenderedSlices, EveryTexelHoldsTheFirstHitOfItsRay) {
  for (const char* scene : {"contact", "atrium", "corner", "sheets"}) {
    const World world = open(scene);
    for (const Kind& kind : kinds()) {
      const bool paraboloid = &kind.map == &paraboloidParameterization();
      const FittedMap fitted = test::fitWhole(world, kind.map, paraboloid ? 222 : 128, kind.options);
      const Slices layers = test::drawSlices(device(), world, fitted, CullMode::None);
      // The rasterizer decides on a grid of 1/256 texel; a texel's own ray, to within rounding. On an H200 depths were
      // off by up to 9 times that grid, where a face's edge cuts a large triangle, and 9 times as coarsely rounded.
      const TexelErrors errors = test::compareWithRays(
          world, fitted, layers.z1,
          {.edgeReach = paraboloid ? 1e-3 : 0.02, .tolerance = [&](int slice, glm::ivec2 texel, const SurfaceHit& hit) {
             const double rounded = tolerance(world, fitted, slice, texel, hit);
             if (paraboloid || isLavapipe()) return rounded;
             return 16.0 * rounded + test::distanceChange(fitted, slice, texel, hit, 16.0 * cornerGrid());
           }});
      EXPECT_EQ(errors.off, 0u) << scene << ", " << kind.name << ", worst " << errors.worst << " m, "
                                << errors.worstShare << " of what is allowed";
      EXPECT_LT(errors.atEdges, errors.held / (paraboloid     ? 5000
                                               : isLavapipe() ? 1000
                                                              : 500))
          << scene << ", " << kind.name;
      EXPECT_GT(errors.covered, errors.held / 8) << scene;
    }
  }
}

TEST_F(RenderedSlices, BlendedPeeledAndOrderedSecondLayersAreEqualBitForBit) {
  for (const char* scene : {"contact", "sheets", "atrium"}) {
    const World world = open(scene);
    for (const Kind& kind : kindsOfAllRasters()) {
      const FittedMap fitted = test::fitWhole(world, kind.map, 64, kind.options);
      for (const CullMode cull : {CullMode::None, CullMode::Solids}) {
        const Slices blended =
            test::drawSlices(device(), world, fitted, cull, glsl::kChannelSecondDepth, SecondLayer::Blend);
        const Slices peeled =
            test::drawSlices(device(), world, fitted, cull, glsl::kChannelSecondDepth, SecondLayer::Peel);
        EXPECT_EQ(blended.z1, peeled.z1) << scene << ", " << kind.name;
        EXPECT_EQ(blended.z2, peeled.z2) << scene << ", " << kind.name;
        if (device().info().orderedAttachmentAccess) {
          const Slices ordered =
              test::drawSlices(device(), world, fitted, cull, glsl::kChannelSecondDepth, SecondLayer::Ordered);
          EXPECT_EQ(ordered.z1, blended.z1) << scene << ", " << kind.name;
          EXPECT_EQ(ordered.z2, blended.z2) << scene << ", " << kind.name;
          const ChannelSet all = glsl::kChannelIds | glsl::kChannelSecondIds;
          const Slices ids = test::drawSlices(device(), world, fitted, cull, all, SecondLayer::Ordered);
          const Slices idsPeeled = test::drawSlices(device(), world, fitted, cull, all, SecondLayer::Peel);
          EXPECT_EQ(ids.z2, blended.z2) << scene << ", " << kind.name;
          EXPECT_EQ(ids.ids, idsPeeled.ids) << scene << ", " << kind.name;
          EXPECT_EQ(ids.secondIds, idsPeeled.secondIds) << scene << ", " << kind.name;
        }
        size_t seconds = 0;
        for (size_t i = 0; i < blended.z1.size(); ++i) {
          ASSERT_TRUE(blended.z2[i] > blended.z1[i] || blended.z2[i] == 1.0f);
          seconds += blended.z2[i] < 1.0f ? 1 : 0;
        }
        EXPECT_GT(seconds, blended.z1.size() / 100) << scene << ", " << kind.name;
      }
    }
  }
}

// What is not sent to a slice changes nothing on it (src/shadow/slice_culling.h).
TEST_F(RenderedSlices, LayersThatAreSentPartsEqualLayersThatAreSentEverything) {
  std::vector<Kind> all = kindsOfAllRasters();
  all.push_back({"paraboloid by vertex", paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Vertex)}});
  for (const char* scene : {"crowd:50000", "double-torus", "sheets"}) {
    World world = test::openWorld(device(), openScene(scene), glm::dvec3(0.3, 1.1, -0.2));
    ASSERT_FALSE(world.buffers.partBoundsW.empty()) << scene;
    for (const Kind& kind : all) {
      const FittedMap fitted = test::fitWhole(world, kind.map, 96, kind.options);
      const auto drawAll = [&] {
        return test::drawSlices(device(), world, fitted, CullMode::None, glsl::kChannelSecondDepth);
      };
      const Slices parts = drawAll();
      std::vector<Draw> cut = world.buffers.draws;
      for (Draw& draw : world.buffers.draws) {
        draw.partCount = 0;
        draw.boundsW = {.lower = glm::vec3(-1e6f), .upper = glm::vec3(1e6f)};
      }
      const Slices whole = drawAll();
      std::swap(cut, world.buffers.draws);
      EXPECT_EQ(parts.z1, whole.z1) << scene << ", " << kind.name;
      EXPECT_EQ(parts.z2, whole.z2) << scene << ", " << kind.name;
    }
  }
}

// Leaving the back faces of solids out changes nothing (map_image_test.cpp says why), whichever way a slice turns the
// winding.
TEST_F(RenderedSlices, CullingSolidsChangesNoTexel) {
  const World world = open("contact");
  ASSERT_TRUE(std::ranges::any_of(world.buffers.draws, &Draw::solid));
  for (const Kind& kind : kindsOfAllRasters()) {
    const FittedMap fitted = test::fitWhole(world, kind.map, 128, kind.options);
    const Slices all = test::drawSlices(device(), world, fitted, CullMode::None);
    const Slices culled = test::drawSlices(device(), world, fitted, CullMode::Solids);
    const Slices back = test::drawSlices(device(), world, fitted, CullMode::Solids, glsl::kChannelBackDepth);
    size_t different = 0, behind = 0;
    for (size_t i = 0; i < all.z1.size(); ++i) {
      ASSERT_LE(all.z1[i], culled.z1[i]);
      ASSERT_LE(all.z1[i], back.zBack[i]);
      different += all.z1[i] != culled.z1[i] ? 1 : 0;
      behind += all.z1[i] < back.zBack[i] ? 1 : 0;
    }
    // Where a front face is cut in pieces and the back face beside it is not, their edge is drawn twice: measured 1.
    const bool inPieces = std::string(kind.name).find("tessellated") != std::string::npos;
    EXPECT_LE(different, inPieces ? 5u : 0u) << kind.name;
    EXPECT_GT(behind, all.z1.size() / 200) << kind.name;
  }
}

}  // namespace
}  // namespace gnomon
