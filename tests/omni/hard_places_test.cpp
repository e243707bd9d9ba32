// Where paraboloids and cubes usually fail: huge triangles, lights in boxes, on surfaces and far away, a far
// end that is too near.
#include "omni/paraboloid_map.h"
#include "omni_fixture.h"
#include "scene/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using test::Slices;
using test::TexelErrors;
using test::World;

Scene emptyScene() {
  Scene scene;
  scene.name = "by hand";
  scene.materials.push_back({.name = "grey", .doubleSided = true});
  return scene;
}

void add(Scene& scene, MeshBuilder& builder) {
  scene.meshes.push_back(builder.build());
  scene.instances.push_back({.name = "", .mesh = static_cast<int>(scene.meshes.size()) - 1});
}

// A square floor of 2 n^2 triangles, 40 m wide, 2 m below the light.
Scene floorOf(int n) {
  Scene scene = emptyScene();
  MeshBuilder builder("floor", 0);
  const auto at = [&](int x, int z) { return glm::dvec3(40.0 * x / n - 20.0, -2.0, 40.0 * z / n - 20.0); };
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) builder.quad(at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z));
  add(scene, builder);
  return scene;
}

Scene box(const glm::dvec3& lower, const glm::dvec3& upper) {
  Scene scene = emptyScene();
  MeshBuilder builder("box", 0);
  builder.box(lower, upper);
  add(scene, builder);
  return scene;
}

MapOptions rasterized(ParaboloidRaster raster, const glm::dvec3& axisW) {
  return {kParaboloidRaster(raster), kParaboloidAxisW(glm::normalize(axisW))};
}

class HardPlaces : public gpu::GpuTest {
 protected:
  // Off by more than a ten-thousandth of the distance.
  TexelErrors errorsOf(const World& world, const FittedMap& fitted) {
    const Slices layers = test::drawSlices(device(), world, fitted, CullMode::None);
    return test::compareWithRays(
        world, fitted, layers.z1,
        {.edgeReach = 0.01, .tolerance = [&](int slice, glm::ivec2 texel, const SurfaceHit& hit) {
           return 1e-4 * (hit.distance + fitted.zNear) + test::distanceChange(fitted, slice, texel, hit, cornerGrid());
         }});
  }
  std::vector<FittedMap> mapsOf(const World& world) {
    return {
        test::fitWhole(world, cubeParameterization(), 64),
        test::fitWhole(world, cubeParameterization(), 64, {kCubeDepth(CubeDepth::Radial)}),
        test::fitWhole(world, paraboloidParameterization(), 111),
        test::fitWhole(world, paraboloidParameterization(), 111, rasterized(ParaboloidRaster::Exact, {1.0, 0.2, 0.3}))};
  }
};

// The seam runs through the floor (axis 1,0,0), or far above it.
TEST_F(HardPlaces, ExactDoesNotDependOnTessellationAndVertexDoes) {
  for (const glm::dvec3 axis : {glm::dvec3(0, -1, 0), glm::dvec3(1, -0.2, 0.1)}) {
    size_t different[2] = {}, off[2] = {};
    for (const ParaboloidRaster raster : {ParaboloidRaster::Exact, ParaboloidRaster::Vertex}) {
      std::vector<float> depths[2];
      for (const int n : {1, 100}) {
        const World world = test::openWorld(device(), floorOf(n), glm::dvec3(0.3, 0.0, 0.1));
        const FittedMap fitted = test::fitWhole(world, paraboloidParameterization(), 256, rasterized(raster, axis));
        depths[n == 1 ? 0 : 1] = test::drawSlices(device(), world, fitted, CullMode::None).z1;
        if (n == 1) off[raster == ParaboloidRaster::Exact ? 0 : 1] = errorsOf(world, fitted).off;
      }
      for (size_t i = 0; i < depths[0].size(); ++i)
        // Two planes of the same floor, each rounded: 2^-22 of depth times at most the floor's slant of 1/10.
        different[raster == ParaboloidRaster::Exact ? 0 : 1] += std::abs(depths[0][i] - depths[1][i]) > 3e-6f ? 1 : 0;
    }
    EXPECT_EQ(different[0], 0u);
    EXPECT_EQ(off[0], 0u);
    EXPECT_GT(different[1], 1000u);
    EXPECT_GT(off[1], 1000u);
  }
}

// Held texels whose depth is not between those of the rays within one texel of them, beyond the rim too.
size_t texelsAstray(const World& world, const FittedMap& fitted, const std::vector<float>& depths) {
  const int side = fitted.map.width, wide = side + 2;
  const float range = fitted.zFar - fitted.zNear;
  size_t astray = 0;
  for (int slice = 0; slice < fitted.map.sliceCount; ++slice) {
    std::vector<float> exact(static_cast<size_t>(wide) * wide);  // one more texel on each side
    for (int y = 0; y < wide; ++y)
      for (int x = 0; x < wide; ++x) {
        const auto hit = world.tracer->firstHit(test::rayThrough(fitted, slice, glm::dvec2(x, y) - 0.5));
        exact[static_cast<size_t>(y) * wide + x] = hit ? static_cast<float>(hit->distance) / range : 1.0f;
      }
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (!glsl::mapHoldsTexel(fitted.map, slice, {x, y})) continue;
        float low = INFINITY, high = -INFINITY;
        for (int v = y; v <= y + 2; ++v)
          for (int u = x; u <= x + 2; ++u) {
            low = std::min(low, exact[static_cast<size_t>(v) * wide + u]);
            high = std::max(high, exact[static_cast<size_t>(v) * wide + u]);
          }
        // Half a texel across the ray, and as much along it: a texel's width at this distance, at the rim
        // 2 / side radians.
        const float width = (low * range + fitted.zNear) * 2.0f / static_cast<float>(side) / range;
        const float slack = 0.5f * (high - low) + width + 3e-6f;
        const float depth = depths[(static_cast<size_t>(slice) * side + y) * side + x];
        astray += depth < low - slack || depth > high + slack ? 1 : 0;
      }
    }
  }
  return astray;
}

TEST_F(HardPlaces, TessellatedIsRightToATexelAndVertexIsNot) {
  for (const double height : {0.5, 0.0, -1.0, -1.95}) {
    const World world = test::openWorld(device(), floorOf(1), glm::dvec3(0.3, height, 0.1));
    for (const glm::dvec3 axis : {glm::dvec3(0, -1, 0), glm::dvec3(1, -0.2, 0.1)}) {
      const auto astray = [&](ParaboloidRaster raster, int side) {
        const FittedMap fitted = test::fitWhole(world, paraboloidParameterization(), side, rasterized(raster, axis));
        return texelsAstray(world, fitted, test::drawSlices(device(), world, fitted, CullMode::None).z1);
      };
      EXPECT_EQ(astray(ParaboloidRaster::Exact, 256), 0u) << height;
      EXPECT_EQ(astray(ParaboloidRaster::Tessellated, 256), 0u) << height;
      EXPECT_EQ(astray(ParaboloidRaster::Tessellated, 111), 0u) << height;
      EXPECT_GT(astray(ParaboloidRaster::Vertex, 256), 1000u) << height;
    }
  }
}

TEST_F(HardPlaces, InsideAClosedBoxEveryTexelIsCovered) {
  const World world = test::openWorld(device(), box({-1, -2, -3}, {4, 3, 2}), glm::dvec3(0.5, 0.2, -0.4));
  for (const FittedMap& fitted : mapsOf(world)) {
    const TexelErrors errors = errorsOf(world, fitted);
    EXPECT_EQ(errors.covered, errors.held) << fitted.map.kind;
    EXPECT_EQ(errors.off, 0u) << fitted.map.kind << ", worst " << errors.worst;
    EXPECT_LT(errors.atEdges, errors.held / 200) << fitted.map.kind;
  }
}

// A light in the very plane of a face: the face is seen edge-on and casts nothing, the rest is as it is.
TEST_F(HardPlaces, OnASurfaceTheRestIsRight) {
  const World world = test::openWorld(device(), box({-1, -2, -3}, {4, 3, 2}), glm::dvec3(0.5, -2.0, -0.4));
  for (const FittedMap& fitted : mapsOf(world)) {
    const Slices layers = test::drawSlices(device(), world, fitted, CullMode::None);
    size_t empty = 0, texels = 0, wrong = 0;
    for (int slice = 0; slice < fitted.map.sliceCount; ++slice) {
      for (int y = 0; y < fitted.map.width; ++y) {
        for (int x = 0; x < fitted.map.width; ++x) {
          if (!glsl::mapHoldsTexel(fitted.map, slice, {x, y})) continue;
          const RayD ray = test::rayThrough(fitted, slice, glm::dvec2(x, y) + 0.5);
          // Nearly in the plane; a GPU's grid makes a sliver of the face there, a texel wide.
          if (std::abs(ray.dir.y) < (isLavapipe() ? 0.02 : 0.05)) continue;
          const float stored = layers.z1[(static_cast<size_t>(slice) * fitted.map.width + y) * fitted.map.width + x];
          ++texels;
          if (ray.dir.y < 0.0) {
            ++empty;
            wrong += stored != 1.0f ? 1 : 0;
            continue;
          }
          const auto hit = world.tracer->firstHit({ray.origin + ray.dir * 0.01, ray.dir});
          ASSERT_TRUE(hit);
          const glsl::Ray rayL = glsl::mapTexelRay(fitted.map, slice, glsl::mapTexelCenter(fitted.map, {x, y}));
          // The near end stands at 1e-5 of the diagonal: hyperbolic depth leaves 2^-24 d^2 / near.
          const double tolerance = fitted.map.kind == glsl::kMapCube ? 6e-8 * 60.0 / fitted.map.zNear : 2e-3;
          const double distance = glsl::mapDistance(fitted.map, slice, rayL, stored);
          wrong += std::abs(distance - (hit->distance + 0.01)) <=
                           tolerance + test::distanceChange(fitted, slice, {x, y}, *hit, 16.0 * cornerGrid())
                       ? 0
                       : 1;
        }
      }
    }
    // On its grid a GPU draws slivers of the face, whose depth is the near end's.
    EXPECT_LE(wrong, isLavapipe() ? 0 : texels / 1000) << fitted.map.kind;
    EXPECT_GT(empty, 5000u);
  }
}

TEST_F(HardPlaces, FarBeyondTheSceneItIsStillFound) {
  const World world = test::openWorld(device(), box({-1, -1, -1}, {1, 1, 1}), glm::dvec3(6.0, 3.0, -5.0));
  for (const FittedMap& fitted : mapsOf(world)) {
    const TexelErrors errors = errorsOf(world, fitted);
    EXPECT_GT(errors.covered, 20u);
    EXPECT_EQ(errors.off, 0u) << fitted.map.kind;
  }
}

// What lies behind the far end is not in the map, and nothing before it changes.
TEST_F(HardPlaces, AFarEndTooNearLosesOnlyWhatLiesBehindIt) {
  const World world = test::openWorld(device(), findGeneratedScene("atrium")->make());
  const double near = 0.05, far = 4.0;
  const float scale = computeBounds(world.scene).diagonal();
  const std::vector<std::pair<FittedMap, FittedMap>> pairs = {
      {makeCubeMap(world.light.positionW, CubeDepth::Radial, near, far, 64, scale),
       makeCubeMap(world.light.positionW, CubeDepth::Radial, near, 40.0, 64, scale)},
      {makeParaboloidMap(world.light.positionW, {0, -1, 0}, ParaboloidRaster::Exact, near, far, 111, scale),
       makeParaboloidMap(world.light.positionW, {0, -1, 0}, ParaboloidRaster::Exact, near, 40.0, 111, scale)}};
  for (const auto& [cut, whole] : pairs) {
    const Slices a = test::drawSlices(device(), world, cut, CullMode::None);
    const Slices b = test::drawSlices(device(), world, whole, CullMode::None);
    size_t behind = 0, before = 0;
    for (size_t i = 0; i < a.z1.size(); ++i) {
      const double metres = near + b.z1[i] * (40.0 - near);
      if (std::abs(metres - far) < 1e-4) continue;
      if (metres > far) {
        ++behind;
        ASSERT_EQ(a.z1[i], 1.0f);
      } else {
        ++before;
        ASSERT_NEAR(near + a.z1[i] * (far - near), metres, 2e-5);
      }
    }
    EXPECT_GT(behind, 3000u);
    EXPECT_GT(before, 3000u);
  }
}

}  // namespace
}  // namespace gnomon
