// What the rasterizer stores against exact rays through the same texels.
#include "map_fixture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace gnomon {
namespace {

// Vertices stand on a grid of 1/256 texel, so that an edge is drawn up to sqrt(2) / 512 of a texel from where rays meet
// it: texels whose centre is no farther from an edge may hold what lies on the other side of it. Of those that an edge
// crosses these are twice that, 0.0055; where it crosses no more than one texel in ten, one texel in 1800 of all.
constexpr double kEdgeReach = 1.0 / 256.0;
constexpr size_t kOffAtEdges = 1800;

using Hit = std::optional<SurfaceHit>;

RayD texelRay(const FittedMap& fitted, int x, int y) {
  return test::rayThrough(fitted, 0, glm::dvec2(x, y) + 0.5);
}

// Behind the first hit by more than both are rounded: coordinates of up to 20 m to 2^-24.
Hit secondHit(const Tracer& tracer, const RayD& ray) {
  const Hit first = tracer.firstHit(ray);
  if (!first) return first;
  const double begin = first->distance + 2e-5;
  Hit second = tracer.firstHit({ray.origin + ray.dir * begin, ray.dir});
  if (second) second->distance += begin;
  return second;
}

// What a map holds of a hit of a texel's ray.
float depthOf(const FittedMap& fitted, const RayD& ray, const Hit& hit) {
  if (!hit) return 1.0f;
  const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(ray.origin + ray.dir * hit->distance));
  return std::min(glsl::mapDepth(fitted.map, 0, posL), 1.0f);
}

// Where the rays on all sides of a texel's centre, `reach` away, do not all hit one triangle.
bool isNearEdge(const FittedMap& fitted, int x, int y, double reach, const std::function<Hit(const RayD&)>& hitOf) {
  std::optional<Primitive> seen;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 aside(i % 2 == 0 ? -reach : reach, i / 2 == 0 ? -reach : reach);
    const Hit hit = hitOf(test::rayThrough(fitted, 0, glm::dvec2(x, y) + 0.5 + aside));
    if (!hit || (i > 0 && !(*seen == hit->primitive))) return true;
    seen = hit->primitive;
  }
  return false;
}

// The rasterizer evaluates z = a + x dz/dx + y dz/dy in floats, and a and the products are as large as the plane's
// change of depth across the whole map: each rounds by 2^-24 of that. 16 more are the transforms of both sides.
// On a device that interpolates between moved corners, each is off the plane by what depth changes over that way.
float rasterTolerance(const FittedMap& fitted, const SurfaceHit& hit, int x, int y, double cornerGrid) {
  const auto planeDepth = [&](int tx, int ty) {
    const RayD ray = texelRay(fitted, tx, ty);
    const RayD here = texelRay(fitted, x, y);
    const glm::dvec3 point = here.origin + here.dir * hit.distance;
    const double t = glm::dot(hit.normalW, point - ray.origin) / glm::dot(hit.normalW, ray.dir);
    const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(ray.origin + ray.dir * t));
    return glsl::mapDepth(fitted.map, 0, posL);
  };
  const float change =
      std::abs(planeDepth(x + 1, y) - planeDepth(x, y)) + std::abs(planeDepth(x, y + 1) - planeDepth(x, y));
  return 5.97e-8f * (16.0f + 2.0f * change * static_cast<float>(fitted.map.width)) +
         static_cast<float>(cornerGrid) * change;
}

class MapImageTest : public gpu::GpuTest {
 protected:
  // Texels whose stored depth is off by more than the rasterizer rounds, edges apart.
  void compareWithRays(const std::string& scene, const Parameterization& map) {
    const test::Rendered r = test::render(device(), scene, map, 128, 256, CullMode::None);
    const std::vector<float> depths = gpu::downloadAs<float>(device(), r.image->depth());
    size_t off = 0, offAtEdges = 0, covered = 0;
    const auto firstHit = [&](const RayD& ray) { return r.tracer->firstHit(ray); };
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const RayD ray = texelRay(r.fitted, x, y);
        const Hit hit = firstHit(ray);
        covered += hit ? 1 : 0;
        const float stored = depths[static_cast<size_t>(y) * 256 + x];
        const float tolerance = hit ? rasterTolerance(r.fitted, *hit, x, y, cornerGrid()) : 0.0f;
        if (std::abs(stored - depthOf(r.fitted, ray, hit)) <= tolerance) continue;
        ++(isNearEdge(r.fitted, x, y, kEdgeReach, firstHit) ? offAtEdges : off);
      }
    }
    EXPECT_EQ(off, 0u) << scene << " " << map.name();
    EXPECT_LT(offAtEdges, 256u * 256u / kOffAtEdges) << scene << " " << map.name();
    EXPECT_GT(covered, 256u * 256u / 4);
  }
};

TEST_F(MapImageTest, EveryTexelHoldsTheFirstHitOfItsRaySpot) {
  compareWithRays("contact", spotParameterization());
}

TEST_F(MapImageTest, EveryTexelHoldsTheFirstHitOfItsRayDirectional) {
  compareWithRays("lshape", directionalParameterization());
}

TEST_F(MapImageTest, EveryTexelHoldsTheFirstHitOfItsRayInInstances) {
  compareWithRays("crowd:20000", spotParameterization());
}

// A closed solid seen from outside has a front face before every back face, and the rasterizer covers the texels within
// an outline with the one as with the other: leaving the back faces out changes no texel.
TEST_F(MapImageTest, CullingSolidsChangesNoTexel) {
  const test::Rendered all = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::None);
  const test::Rendered culled = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::Solids);
  EXPECT_TRUE(std::ranges::any_of(all.buffers.draws, &Draw::solid));
  EXPECT_EQ(gpu::download(device(), all.image->depth()), gpu::download(device(), culled.image->depth()));
}

// The holes of an alpha mask let light through in the map as they do for rays (`sheets` has a masked fence).
TEST_F(MapImageTest, HolesOfMasksAreHolesOfTheMap) {
  const test::Rendered r = test::render(device(), "sheets", spotParameterization(), 128, 256, CullMode::None);
  ASSERT_TRUE(std::ranges::any_of(r.buffers.draws, &Draw::masked));
  const std::vector<float> depths = gpu::downloadAs<float>(device(), r.image->depth());
  Scene opaque = findGeneratedScene("sheets")->make();
  for (Material& material : opaque.materials) material.alphaMode = AlphaMode::Opaque;
  const Tracer withoutHoles(opaque);
  const auto firstHit = [&](const RayD& ray) { return r.tracer->firstHit(ray); };
  size_t holes = 0, off = 0, offAtRims = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const RayD ray = texelRay(r.fitted, x, y);
      const Hit through = firstHit(ray), blocked = withoutHoles.firstHit(ray);
      if (!through || !blocked || through->primitive == blocked->primitive) continue;
      ++holes;
      const float stored = depths[static_cast<size_t>(y) * 256 + x];
      if (std::abs(stored - depthOf(r.fitted, ray, through)) <= rasterTolerance(r.fitted, *through, x, y, cornerGrid()))
        continue;
      ++(isNearEdge(r.fitted, x, y, kEdgeReach, firstHit) ? offAtRims : off);
    }
  }
  EXPECT_GT(holes, 1000u);
  EXPECT_EQ(off, 0u);
  EXPECT_LT(offAtRims, 5u);  // of the texels that a rim crosses 0.0055
}

// The paper's peel, the blend and the pass in order give the same two layers, to the bit, on every generated scene,
// culled and not.
TEST_F(MapImageTest, BlendingPeelingAndDrawingInOrderGiveTheSameTwoLayers) {
  for (const GeneratedScene& generated : generatedScenes()) {
    for (const Parameterization* map : planarParameterizations()) {
      const test::Rendered r = test::render(device(), generated.name, *map, 64, 192, CullMode::None);
      for (const CullMode cull : {CullMode::None, CullMode::Solids}) {
        const auto blended = test::draw(device(), r, glsl::kChannelSecondDepth, cull, SecondLayer::Blend);
        const auto peeled = test::draw(device(), r, glsl::kChannelSecondDepth, cull, SecondLayer::Peel);
        EXPECT_EQ(gpu::download(device(), blended->depth()), gpu::download(device(), peeled->depth()));
        EXPECT_EQ(gpu::download(device(), blended->secondDepth()), gpu::download(device(), peeled->secondDepth()))
            << generated.name << " " << map->name();
        if (device().info().orderedAttachmentAccess) {
          const auto ordered = test::draw(device(), r, glsl::kChannelSecondDepth, cull, SecondLayer::Ordered);
          EXPECT_TRUE(ordered->drawsInOrder());
          EXPECT_EQ(gpu::download(device(), blended->depth()), gpu::download(device(), ordered->depth()));
          EXPECT_EQ(gpu::download(device(), blended->secondDepth()), gpu::download(device(), ordered->secondDepth()))
              << generated.name << " " << map->name();
        }
        const auto z1 = gpu::downloadAs<float>(device(), blended->depth());
        const auto z2 = gpu::downloadAs<float>(device(), blended->secondDepth());
        for (size_t i = 0; i < z1.size(); ++i) ASSERT_TRUE(z2[i] > z1[i] || z2[i] == 1.0f);
      }
    }
  }
}

// The second layer is the second hit of the texel's ray.
TEST_F(MapImageTest, TheSecondLayerIsTheSecondHitOfItsRay) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::None);
  const auto image = test::draw(device(), r, glsl::kChannelSecondDepth, CullMode::None);
  const auto z1 = gpu::downloadAs<float>(device(), image->depth());
  const auto z2 = gpu::downloadAs<float>(device(), image->secondDepth());
  const auto hitOf = [&](const RayD& ray) { return secondHit(*r.tracer, ray); };
  size_t seconds = 0, off = 0, offAtEdges = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const size_t i = static_cast<size_t>(y) * 256 + x;
      ASSERT_LE(z1[i], z2[i]);
      const RayD ray = texelRay(r.fitted, x, y);
      const Hit second = hitOf(ray);
      seconds += second ? 1 : 0;
      const float tolerance = second ? rasterTolerance(r.fitted, *second, x, y, cornerGrid()) : 0.0f;
      if (std::abs(z2[i] - depthOf(r.fitted, ray, second)) <= tolerance) continue;
      ++(isNearEdge(r.fitted, x, y, kEdgeReach, hitOf) ? offAtEdges : off);
    }
  }
  EXPECT_GT(seconds, 5000u);
  EXPECT_EQ(off, 0u);
  EXPECT_LT(offAtEdges, 256u * 256u / kOffAtEdges);
}

// Wang & Molnar 1994: nothing that a solid's lit side could be compared with is in the map, so solids alone
// show no acne.
TEST_F(MapImageTest, BackFacesLieBehindFrontFaces) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::None);
  const auto back = test::draw(device(), r, glsl::kChannelBackDepth, CullMode::Solids);
  const auto a = gpu::downloadAs<float>(device(), r.image->depth());
  const auto b = gpu::downloadAs<float>(device(), back->image(glsl::kChannelBackDepth));
  size_t behind = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_LE(a[i], b[i]);
    behind += a[i] < b[i] ? 1 : 0;
  }
  EXPECT_GT(behind, a.size() / 20);
}

}  // namespace
}  // namespace gnomon
