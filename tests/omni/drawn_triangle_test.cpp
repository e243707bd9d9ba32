// The channel `ids` names the triangle that a texel's own ray meets first, however the slice is drawn: by ranges of an
// indexed mesh, by pieces of triangles, by bounds; on planar maps, their warps and cascades; the second layer's too.
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "omni_fixture.h"
#include "planar/planar_map.h"
#include "tests/truth/scenes_by_hand.h"

#include <cmath>
#include <numbers>

namespace gnomon {
namespace {

class DrawnTriangle : public gpu::GpuTest {};

struct Kind {
  const char* label;
  const Parameterization& map;
  MapOptions options;
  bool straight = false;  // edges that should be arcs are drawn straight
};

std::vector<Kind> omniKinds() {
  return {{"cube", cubeParameterization(), {kCubeDepth(CubeDepth::Hyperbolic)}},
          {"cube, radial", cubeParameterization(), {kCubeDepth(CubeDepth::Radial)}},
          {"paraboloid", paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Exact)}},
          {"paraboloid, tessellated",
           paraboloidParameterization(),
           {kParaboloidRaster(ParaboloidRaster::Tessellated)},
           true}};
}

std::vector<Kind> planarKinds() {
  return {{"spot", spotParameterization(), {}},
          {"spot, LiSPSM", spotParameterization(), {kWarp(Warp::Lispsm)}},
          {"directional", directionalParameterization(), {}},
          {"directional, TSM", directionalParameterization(), {kWarp(Warp::Tsm)}},
          {"cascades", directionalParameterization(), {kCascades(3)}}};
}

struct Named {
  size_t drawn = 0;    // texels that name a triangle
  size_t others = 0;   // another than the ray meets first
  size_t atEdges = 0;  // of these, which a ray a fiftieth of a texel aside meets
};

// The nearest triangles of a map; `ids` as MapImage holds them.
Named nameTexels(const Tracer& tracer, const SceneBuffers& buffers, const FittedMap& fitted, const LightRays& rays,
                 const std::vector<uint32_t>& ids) {
  constexpr double kReach = 0.02;  // texels; the rasterizer's grid is 1/256
  Named named;
  const int side = fitted.map.width;
  const auto firstAt = [&](int slice, const glm::dvec2& place) {
    return tracer.firstHit(rays.normalized(test::rayThrough(fitted, slice, place)));
  };
  for (size_t i = 0; i < ids.size(); ++i) {
    const int slice = static_cast<int>(i) / (side * side);
    const glm::dvec2 center(static_cast<int>(i) % side + 0.5, static_cast<int>(i) / side % side + 0.5);
    const glsl::PrimitiveId stored = primitiveOf(buffers.ids, buffers.firstTriangles, ids[i]);
    const auto isStored = [&](const std::optional<SurfaceHit>& hit) {
      return hit ? stored.instancePlusOne == hit->primitive.instance + 1 && stored.triangle == hit->primitive.triangle
                 : stored.instancePlusOne == 0;
    };
    named.drawn += ids[i] != glsl::kNoId ? 1 : 0;
    if (!glsl::mapHoldsTexel(fitted.map, slice, glm::ivec2(center)) || isStored(firstAt(slice, center))) continue;
    ++named.others;
    for (int direction = 0; direction < 16; ++direction) {
      const double azimuth = std::numbers::pi / 8.0 * direction;
      const glm::dvec2 aside(std::cos(azimuth), std::sin(azimuth));
      if (!isStored(firstAt(slice, center + kReach * aside))) continue;
      ++named.atEdges;
      break;
    }
  }
  return named;
}

// As many as 1 in `most` texels may lie on an edge of triangles within the rasterizer's grid.
// Where surfaces cross, depths decide, which a GPU interpolates between corners moved to that grid.
void expectNamed(const Named& named, size_t texels, bool straight, bool movesCorners, const std::string& what) {
  EXPECT_GT(named.drawn, texels / 512) << what;  // planes are few texels of a cube
  if (straight) {  // a straight piece of an arc is off by up to half a texel: 4% of atrium's texels, 10% of factory's
    EXPECT_LT(named.others, named.drawn / 8) << what;
    return;
  }
  EXPECT_LE(named.others, named.drawn / 300) << what;
  // A corner of a silhouette may lie between two of those rays.
  EXPECT_LE(named.others - named.atEdges, named.drawn / (movesCorners ? 200 : 2000)) << what;
}

TEST_F(DrawnTriangle, IsTheFirstThatTheTexelsRayMeets) {
  for (const char* scene : {"lshape", "double-torus", "factory", "atrium", "corner", "grate", "sheets", "contact",
                            "tilted-planes", "near-far", "crowd:50000"}) {
    const test::World world = test::openWorld(device(), openScene(scene));
    for (const Kind& kind : omniKinds()) {
      const FittedMap fitted = test::fitWhole(world, kind.map, 128, kind.options);
      const test::Slices slices = test::drawSlices(device(), world, fitted, CullMode::None, glsl::kChannelIds);
      expectNamed(nameTexels(*world.tracer, world.buffers, fitted, LightRays(world.scene, world.light), slices.ids),
                  slices.ids.size(), kind.straight, cornerGrid() > 0.0, std::string(scene) + ", " + kind.label);
    }
  }
}

// Drawn corner to corner, every edge and every depth is another than the ray's: the finer the mesh, the less so.
TEST_F(DrawnTriangle, BetweenProjectedCornersComesToTheRaysWithTheMeshsFineness) {
  double before = 1.0;
  for (const int rings : {8, 32}) {
    Scene scene = test::emptyScene();
    test::addSphere(scene, {0.0, 0.0, 0.0}, 4.0, rings, 2 * rings);
    test::addSphere(scene, {1.5, 0.5, -1.0}, 0.5, rings / 4, rings / 2);
    scene.lights.push_back({.name = "lamp", .type = LightType::Point, .positionW = {0.3f, 0.2f, 0.1f}});
    const test::World world = test::openWorld(device(), std::move(scene));
    const FittedMap fitted =
        test::fitWhole(world, paraboloidParameterization(), 128, {kParaboloidRaster(ParaboloidRaster::Vertex)});
    const test::Slices slices = test::drawSlices(device(), world, fitted, CullMode::None, glsl::kChannelIds);
    const Named named =
        nameTexels(*world.tracer, world.buffers, fitted, LightRays(world.scene, world.light), slices.ids);
    EXPECT_GT(named.drawn, slices.ids.size() / 2);
    const double share = static_cast<double>(named.others) / static_cast<double>(named.drawn);
    EXPECT_LT(share, before / 2) << rings;
    before = share;
  }
}

TEST_F(DrawnTriangle, OfPlanarMapsToo) {
  for (const char* scene : {"lshape", "double-torus", "factory", "atrium", "corner", "sheets", "contact", "near-far"}) {
    for (const Kind& kind : planarKinds()) {
      const test::Rendered r = test::render(device(), scene, kind.map, 64, 128, CullMode::None, glsl::kChannelIds);
      const FittedMap fitted = kind.map.fit({.scene = r.scene,
                                             .light = r.light,
                                             .receiversW = {},
                                             .side = 128,
                                             .camera = r.view,
                                             .options = kind.options});
      MapImage image(device(), fitted, glsl::kChannelIds);
      gpu::Commands commands(device(), "shadow map");
      r.renderer->record(commands, r.buffers, image, r.light, CullMode::None);
      commands.submitAndWait();
      const std::vector<uint32_t> ids = image.downloadIds(device());
      expectNamed(nameTexels(*r.tracer, r.buffers, fitted, LightRays(r.scene, r.light), ids), ids.size(), false,
                  cornerGrid() > 0.0, std::string(scene) + ", " + kind.label);
    }
  }
}

// The second layer names the triangle whose depth it stores.
TEST_F(DrawnTriangle, OfTheSecondLayerHasItsDepth) {
  for (const char* scene : {"sheets", "contact"}) {
    const test::World world = test::openWorld(device(), openScene(scene));
    for (const Kind& kind : omniKinds()) {
      if (kind.straight) continue;
      const FittedMap fitted = test::fitWhole(world, kind.map, 96, kind.options);
      const test::Slices slices =
          test::drawSlices(device(), world, fitted, CullMode::None, glsl::kChannelIds | glsl::kChannelSecondIds);
      const int side = fitted.map.width;
      size_t seconds = 0, off = 0;
      for (size_t i = 0; i < slices.secondIds.size(); ++i) {
        ASSERT_EQ(slices.secondIds[i] != glsl::kNoId, slices.z2[i] < 1.0f);
        ASSERT_EQ(slices.ids[i] != glsl::kNoId, slices.z1[i] < 1.0f);
        if (slices.secondIds[i] == glsl::kNoId) continue;
        ++seconds;
        const glsl::PrimitiveId id = primitiveOf(world.buffers.ids, world.buffers.firstTriangles, slices.secondIds[i]);
        glm::dvec3 c[3];
        world.tracer->corners({id.instancePlusOne - 1, id.triangle}, c);
        const int slice = static_cast<int>(i) / (side * side);
        const glm::ivec2 texel(static_cast<int>(i) % side, static_cast<int>(i) / side % side);
        const RayD ray = test::rayThrough(fitted, slice, glm::dvec2(texel) + 0.5);
        const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
        const double exact = glm::dot(normal, c[0] - ray.origin) / glm::dot(normal, ray.dir);
        const glsl::Ray rayL = glsl::mapTexelRay(fitted.map, slice, glsl::mapTexelCenter(fitted.map, texel));
        const double stored = glsl::mapDistance(fitted.map, slice, rayL, slices.z2[i]);
        off += std::abs(stored - exact) > 1e-3 * exact + 1e-3 ? 1 : 0;
      }
      EXPECT_GT(seconds, slices.z2.size() / 100) << scene << ", " << kind.label;
      EXPECT_LE(off, seconds / 1000) << scene << ", " << kind.label;  // seen edge-on
    }
  }
}

}  // namespace
}  // namespace gnomon
