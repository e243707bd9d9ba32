// What the rasterizer stores against exact rays through the same texels.
#include "map_fixture.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

RayD texelRay(const FittedMap& fitted, int x, int y) {
  const glsl::Ray ray = glsl::mapTexelRay(fitted.map, 0, glsl::mapTexelCenter(fitted.map, {x, y}));
  const glm::dmat3 worldFromLight(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                  glm::dvec3(fitted.frame.backW));
  return {.origin = glm::dvec3(fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
          .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
}

// The four corners of the middle half of a texel: where they do not all see one triangle, the texel's centre
// is near an edge of one, and the rasterizer's grid of 1/256 texel may decide it otherwise than the ray.
bool isNearPrimitiveEdge(const Tracer& tracer, const FittedMap& fitted, int x, int y) {
  std::optional<Primitive> seen;
  for (int i = 0; i < 4; ++i) {
    const glm::vec2 uv = (glm::vec2(x, y) + 0.5f + 0.02f * glm::vec2((i & 1) * 2 - 1, (i >> 1) * 2 - 1)) /
                         static_cast<float>(fitted.map.side);
    const glsl::Ray ray = glsl::mapTexelRay(fitted.map, 0, uv);
    const glm::dmat3 worldFromLight(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                    glm::dvec3(fitted.frame.backW));
    const auto hit =
        tracer.firstHit({.origin = glm::dvec3(fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
                         .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))});
    if (!hit) return true;
    if (i > 0 && !(*seen == hit->primitive)) return true;
    seen = hit->primitive;
  }
  return false;
}

// The rasterizer evaluates z = a + x dz/dx + y dz/dy in floats, and a and the products are as large as the
// plane's change of depth across the whole map: each rounds by 2^-24 of that. 16 more are the transforms of
// both sides.
float rasterTolerance(const FittedMap& fitted, const SurfaceHit& hit, int x, int y) {
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
  return 5.97e-8f * (16.0f + 2.0f * change * static_cast<float>(fitted.map.side));
}

class MapImageTest : public gpu::GpuTest {
 protected:
  // Texels whose stored depth is off by more than the rasterizer rounds, edges apart.
  void compareWithRays(const std::string& scene, const Parameterization& map) {
    const test::Rendered r = test::render(device(), scene, map, 128, 256, CullMode::None);
    const std::vector<float> depths = gpu::downloadAs<float>(device(), r.image->depth());
    size_t off = 0, offAtEdges = 0, covered = 0;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const auto hit = r.tracer->firstHit(texelRay(r.fitted, x, y));
        const float stored = depths[static_cast<size_t>(y) * 256 + x];
        float expected = 1.0f;
        if (hit) {
          const glsl::Ray ray = glsl::mapTexelRay(r.fitted.map, 0, glsl::mapTexelCenter(r.fitted.map, {x, y}));
          expected = glsl::mapDepth(r.fitted.map, 0, ray.origin + ray.dir * static_cast<float>(hit->distance));
          ++covered;
        }
        const float tolerance = hit ? rasterTolerance(r.fitted, *hit, x, y) : 0.0f;
        if (std::abs(stored - std::min(expected, 1.0f)) <= tolerance) continue;
        if (isNearPrimitiveEdge(*r.tracer, r.fitted, x, y))
          ++offAtEdges;
        else
          ++off;
      }
    }
    EXPECT_EQ(off, 0u) << scene << " " << map.name();
    EXPECT_LT(offAtEdges, 256u * 256u / 50) << scene << " " << map.name();
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

// A closed solid seen from outside has a front face before every back face, so leaving the back faces out
// changes no texel but those where its silhouette falls between the sample points.
TEST_F(MapImageTest, CullingSolidsChangesOnlySilhouettes) {
  const test::Rendered all = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::None);
  const test::Rendered culled = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::Solids);
  const auto a = gpu::downloadAs<float>(device(), all.image->depth());
  const auto b = gpu::downloadAs<float>(device(), culled.image->depth());
  size_t different = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_LE(a[i], b[i]);  // leaving faces out can only uncover
    different += a[i] != b[i] ? 1 : 0;
  }
  EXPECT_LT(different, a.size() / 1000);
  EXPECT_TRUE(std::ranges::any_of(all.buffers.draws, &Draw::solid));
}

// The holes of an alpha mask let light through in the map as they do for rays (`sheets` has a masked fence).
TEST_F(MapImageTest, HolesOfMasksAreHolesOfTheMap) {
  const test::Rendered r = test::render(device(), "sheets", spotParameterization(), 128, 256, CullMode::None);
  ASSERT_TRUE(std::ranges::any_of(r.buffers.draws, &Draw::masked));
  const std::vector<float> depths = gpu::downloadAs<float>(device(), r.image->depth());
  Scene opaque = findGeneratedScene("sheets")->make();
  for (Material& material : opaque.materials) material.alphaMode = AlphaMode::Opaque;
  const Tracer withoutHoles(opaque);
  size_t holes = 0, wrong = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const RayD ray = texelRay(r.fitted, x, y);
      const auto through = r.tracer->firstHit(ray);
      const auto blocked = withoutHoles.firstHit(ray);
      if (!through || !blocked || std::abs(through->distance - blocked->distance) < 0.05) continue;
      ++holes;
      const glsl::Ray rayL = glsl::mapTexelRay(r.fitted.map, 0, glsl::mapTexelCenter(r.fitted.map, {x, y}));
      const float stored = glsl::mapDistance(r.fitted.map, 0, rayL, depths[static_cast<size_t>(y) * 256 + x]);
      if (std::abs(stored - static_cast<float>(through->distance)) > 0.02f) ++wrong;
    }
  }
  EXPECT_GT(holes, 50u);
  EXPECT_LT(wrong, holes / 20);  // at the rims of holes
}

// The paper's peel and the blend give the same two layers, to the bit, on every generated scene, culled and
// not.
TEST_F(MapImageTest, BlendingAndPeelingGiveTheSameTwoLayers) {
  for (const GeneratedScene& generated : generatedScenes()) {
    for (const Parameterization* map : planarParameterizations()) {
      const test::Rendered r = test::render(device(), generated.name, *map, 64, 192, CullMode::None);
      for (const CullMode cull : {CullMode::None, CullMode::Solids}) {
        const auto blended = test::draw(device(), r, glsl::kChannelSecondDepth, cull, SecondLayer::Blend);
        const auto peeled = test::draw(device(), r, glsl::kChannelSecondDepth, cull, SecondLayer::Peel);
        EXPECT_EQ(gpu::download(device(), blended->depth()), gpu::download(device(), peeled->depth()));
        EXPECT_EQ(gpu::download(device(), blended->secondDepth()), gpu::download(device(), peeled->secondDepth()))
            << generated.name << " " << map->name();
        const auto z1 = gpu::downloadAs<float>(device(), blended->depth());
        const auto z2 = gpu::downloadAs<float>(device(), blended->secondDepth());
        for (size_t i = 0; i < z1.size(); ++i) ASSERT_TRUE(z2[i] > z1[i] || z2[i] == 1.0f);
      }
    }
  }
}

// The second layer is the second hit of the texel's ray, but near the edges of what is hit.
TEST_F(MapImageTest, TheSecondLayerIsTheSecondHitOfItsRay) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 256, CullMode::None);
  const auto image = test::draw(device(), r, glsl::kChannelSecondDepth, CullMode::None);
  const auto z1 = gpu::downloadAs<float>(device(), image->depth());
  const auto z2 = gpu::downloadAs<float>(device(), image->secondDepth());
  size_t compared = 0, off = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const RayD ray = texelRay(r.fitted, x, y);
      const auto first = r.tracer->firstHit(ray);
      if (!first || isNearPrimitiveEdge(*r.tracer, r.fitted, x, y)) continue;
      // A thousandth of a metre on: less than any solid of this scene is thick but at its rims and contacts.
      const RayD rest{ray.origin + ray.dir * (first->distance + 1e-3), ray.dir};
      const auto second = r.tracer->firstHit(rest);
      float expected = 1.0f;
      if (second) {
        const glm::dvec3 hitW = rest.origin + rest.dir * second->distance;
        expected = glsl::mapDepth(r.fitted.map, 0, glsl::lightFromWorld(r.fitted.frame, glm::vec3(hitW)));
      }
      ++compared;
      const size_t i = static_cast<size_t>(y) * 256 + x;
      if (std::abs(z2[i] - std::min(expected, 1.0f)) > 1e-4f) ++off;
      ASSERT_LE(z1[i], z2[i]);
    }
  }
  EXPECT_GT(compared, size_t{50000});
  EXPECT_LT(off, compared / 100);
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
