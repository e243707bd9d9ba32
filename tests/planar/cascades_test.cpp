// Splits and slices, and what every planar fit owes to every receiver.
#include "planar/cascades.h"
#include "base/error.h"
#include "judge/texel_density.h"
#include "planar/convex_body.h"
#include "planar/window.h"
#include "tests/shadow/map_fixture.h"
#include "tests/shadow/seen_scene.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using test::SeenScene;

TEST(CascadeSplits, AreTheMeanOfLogarithmicAndUniform) {
  const std::vector<double> splits = cascadeSplits(1.0, 16.0, 2);
  ASSERT_EQ(splits.size(), 3u);
  EXPECT_EQ(splits[0], 1.0);
  EXPECT_DOUBLE_EQ(splits[1], 0.5 * 4.0 + 0.5 * 8.5);
  EXPECT_EQ(splits[2], 16.0);
}

TEST(Cascades, TheFirstThatCoversIsTakenAndTheyGrowCoarser) {
  const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), test::sun(50.0, 60.0), 96);
  const FittedMap fitted = seen.fit(directionalParameterization(), {kCascades(3)}, 512);
  ASSERT_EQ(fitted.map.sliceCount, 3);
  size_t counts[3] = {};
  for (const glm::dvec3& receiver : seen.scored) {
    const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(receiver));
    const glsl::MapPoint point = glsl::mapProject(fitted.map, posL);
    ASSERT_TRUE(point.covered);
    ++counts[point.slice];
    for (int slice = 0; slice < point.slice; ++slice) {  // none before it would have had the point
      glsl::ShadowMap one = fitted.map;
      one.sliceCount = 1;
      one.mapSlices[0] = fitted.map.mapSlices[slice];
      EXPECT_FALSE(glsl::mapProject(one, posL).covered);
    }
    const float depth = glsl::mapDepth(fitted.map, point.slice, posL);
    EXPECT_GT(depth, 0.0f);
    EXPECT_LT(depth, 1.0f);
  }
  // What lies before a split is in the slices that were fitted to it.
  double nearest = 1e30, farthest = 0.0;
  for (const glm::dvec3& receiver : seen.scored) {
    nearest = std::min(nearest, viewDepth(seen.view, receiver));
    farthest = std::max(farthest, viewDepth(seen.view, receiver));
  }
  const std::vector<double> splits = cascadeSplits(nearest, farthest, 3);
  for (const glm::dvec3& receiver : seen.scored) {
    const int slice = glsl::mapProject(fitted.map, glsl::lightFromWorld(fitted.frame, glm::vec3(receiver))).slice;
    for (int later = 1; later < 3; ++later) {
      if (viewDepth(seen.view, receiver) < splits[static_cast<size_t>(later)]) {
        ASSERT_LT(slice, later);
      }
    }
  }
  for (const size_t count : counts) EXPECT_GT(count, seen.scored.size() / 100);
  // Texels of a floor: the windows alone decide.
  double before = 1e30;
  for (int slice = 0; slice < 3; ++slice) {
    glsl::ShadowMap one = fitted.map;
    one.sliceCount = 1;
    one.mapSlices[0] = fitted.map.mapSlices[slice];
    FittedMap single = fitted;
    single.map = one;
    const glsl::Ray ray = glsl::mapTexelRay(one, 0, {0.5f, 0.5f});
    const glm::dvec3 onRay(glsl::worldFromLight(fitted.frame, ray.origin + ray.dir));
    const auto density = texelDensity(single, onRay, -seen.light.directionW);
    ASSERT_TRUE(density.has_value());
    EXPECT_LT(*density, before / 2.0) << slice;
    before = *density;
  }
}

TEST(PlanarFit, EveryReceiverOfEverySceneIsCoveredWithinTheDepthRange) {
  for (const char* scene : {"lshape", "double-torus", "factory", "atrium", "corner", "grate", "sheets", "contact",
                            "tilted-planes", "crowd:20000"}) {
    for (const Parameterization* map : planarParameterizations()) {
      const SeenScene seen = test::see(scene, *map, 48);
      ASSERT_GT(seen.scored.size(), 20u) << scene << " " << map->name();
      for (const MapOptions& options : test::allPlanarOptions()) {
        const FittedMap fitted = seen.fit(*map, options);
        EXPECT_EQ(fitted.map.sliceCount, map->sliceCount(options));
        size_t wrong = 0;
        for (const glm::dvec3& receiver : seen.scored) {
          const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(receiver));
          const glsl::MapPoint point = glsl::mapProject(fitted.map, posL);
          const float depth = glsl::mapDepth(fitted.map, point.slice, posL);
          wrong += point.covered && depth > 0.0f && depth < 1.0f ? 0 : 1;
        }
        EXPECT_EQ(wrong, 0u) << scene << " " << map->name() << ": " << test::describe(options);
      }
    }
  }
}

// No caster between the light and a receiver lies before the near end: rays towards the light, whatever they meet.
TEST(PlanarFit, NoCasterOfAReceiverIsLostBeforeTheNearEnd) {
  for (const char* scene : {"factory", "atrium", "contact"}) {
    for (const Parameterization* map : planarParameterizations()) {
      const SeenScene seen = test::see(scene, *map, 32);
      for (const MapOptions& options : test::allPlanarOptions()) {
        const FittedMap fitted = seen.fit(*map, options);
        size_t lost = 0, met = 0;
        for (const glm::dvec3& receiver : seen.scored) {
          const bool sun = seen.light.type == LightType::Directional;
          const glm::dvec3 origin = sun ? receiver - seen.light.directionW * 100.0 : seen.light.positionW;
          const glm::dvec3 dir = glm::normalize(receiver - origin);
          const auto hit = seen.tracer->firstHit({.origin = origin, .dir = dir});
          if (!hit) continue;
          ++met;
          const glm::vec3 casterL = glsl::lightFromWorld(fitted.frame, glm::vec3(origin + dir * hit->distance));
          const int slice = glsl::mapProject(fitted.map, glsl::lightFromWorld(fitted.frame, glm::vec3(receiver))).slice;
          lost += glsl::mapDepth(fitted.map, slice, casterL) < 0.0f ? 1 : 0;
        }
        EXPECT_EQ(lost, 0u) << scene << " " << map->name() << ": " << test::describe(options);
        EXPECT_GT(met, seen.scored.size() / 2);
      }
    }
  }
}

// Not only what it sees now: anything within the scene's bounds, the view and the cone would be in a tight
// map, and anything within the bounds and the cone in a whole one.
TEST(PlanarFit, TightHoldsWhateverTheCameraCouldSeeAndNoneWhateverTheLightCould) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const char* scene : {"factory", "atrium", "contact", "grate"}) {
    for (const Parameterization* map : planarParameterizations()) {
      const SeenScene seen = test::see(scene, *map, 32);
      const Bounds bounds = computeBounds(*seen.scene);
      for (const int cascades : {1, map->sliceCount({kCascades(3)})}) {
        const FittedMap tight = seen.fit(*map, {kWindowFit(WindowFit::Tight), kSnap(false), kCascades(cascades)});
        const FittedMap whole = seen.fit(*map, {kWindowFit(WindowFit::None), kSnap(false), kCascades(cascades)});
        size_t inView = 0, inCone = 0;
        for (int i = 0; i < 4000; ++i) {
          const glm::vec3 p = glm::mix(bounds.lower, bounds.upper, glm::vec3(unit(random), unit(random), unit(random)));
          const glm::dvec3 fromLight = glm::dvec3(p) - seen.light.positionW;
          if (seen.light.type == LightType::Spot &&
              glm::dot(glm::normalize(fromLight), seen.light.directionW) < std::cos(0.999 * seen.light.outerConeRad))
            continue;
          const glm::vec3 posL = glsl::lightFromWorld(whole.frame, p);
          ++inCone;
          ASSERT_TRUE(glsl::mapProject(whole.map, posL).covered) << scene << " " << map->name();
          const glm::vec4 clip = seen.view.clipFromWorld * glm::vec4(p, 1.0f);
          if (clip.w < clip.z || std::abs(clip.x) > 0.999f * clip.w || std::abs(clip.y) > 0.999f * clip.w) continue;
          ++inView;
          ASSERT_TRUE(glsl::mapProject(tight.map, posL).covered) << scene << " " << map->name();
        }
        EXPECT_GT(inCone, 100u) << scene << " " << map->name();
        EXPECT_GT(inView, 20u) << scene << " " << map->name();
      }
    }
  }
}

TEST(PlanarFit, NoneHoldsWhatTightHoldsAndTightWhatFocusedHolds) {
  for (const char* scene : {"factory", "atrium", "contact", "grate"}) {
    for (const Parameterization* map : planarParameterizations()) {
      const SeenScene seen = test::see(scene, *map, 48);
      FittedMap fits[3];
      for (const WindowFit fit : {WindowFit::None, WindowFit::Tight, WindowFit::Focused})
        fits[static_cast<int>(fit)] = seen.fit(*map, {kWindowFit(fit), kSnap(false)});
      for (const auto& [outer, inner] : {std::pair(0, 1), std::pair(1, 2)}) {
        for (int corner = 0; corner < 4; ++corner) {
          // A quarter of a texel within the smaller one's edge.
          const glm::vec2 uv(0.001f + 0.998f * glm::vec2(corner & 1, corner >> 1));
          const glsl::Ray ray = glsl::mapTexelRay(fits[inner].map, 0, uv);
          EXPECT_TRUE(glsl::mapProject(fits[outer].map, ray.origin + ray.dir).covered)
              << scene << " " << map->name() << " " << outer;
        }
      }
      // And it is not for nothing: the focused window is smaller than the whole.
      const auto area = [](const FittedMap& fitted) {
        const glsl::Ray a = glsl::mapTexelRay(fitted.map, 0, {0.0f, 0.0f});
        const glsl::Ray b = glsl::mapTexelRay(fitted.map, 0, {1.0f, 1.0f});
        const glm::vec3 d = (b.origin + b.dir * (b.origin.z / -b.dir.z)) - (a.origin + a.dir * (a.origin.z / -a.dir.z));
        const glm::vec3 e = b.dir / b.dir.z - a.dir / a.dir.z;
        return std::abs(d.x * d.y) + std::abs(e.x * e.y);
      };
      EXPECT_LT(area(fits[2]), area(fits[0])) << scene << " " << map->name();
    }
  }
}

TEST(ConvexBody, IsWhatTheCameraSeesOfTheBox) {
  const Bounds box{.lower = {-2, -1, -3}, .upper = {2, 3, 4}};
  const glsl::CameraView view = cameraView(lookAt("c", {3, 1.5f, 5}, {-1, 0.5f, -2}, 0.7f), 64, 64);
  ConvexBody body(box);
  body.cutToCamera(view, 0.5, 6.0);
  const std::vector<glm::dvec3> corners = body.corners();
  ASSERT_GE(corners.size(), 4u);
  const auto inside = [&](const glm::dvec3& p, double slack) {
    const double depth = viewDepth(view, p);
    const glm::dvec3 d = p - glm::dvec3(view.eyeW);
    const double x = glm::dot(d, glm::dvec3(view.rightW));
    const double y = glm::dot(d, glm::dvec3(view.upW));
    return glm::all(glm::greaterThan(p, glm::dvec3(box.lower) - slack)) &&
           glm::all(glm::lessThan(p, glm::dvec3(box.upper) + slack)) && depth > 0.5 - slack && depth < 6.0 + slack &&
           std::abs(x) < static_cast<double>(view.tanHalfX) * depth + slack &&
           std::abs(y) < static_cast<double>(view.tanHalfY) * depth + slack;
  };
  for (const glm::dvec3& corner : corners) EXPECT_TRUE(inside(corner, 1e-6));
  // No point of the body lies farther along any direction than its corners do.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dvec3> points;
  while (points.size() < 3000) {
    const glm::dvec3 p =
        glm::mix(glm::dvec3(box.lower), glm::dvec3(box.upper), glm::dvec3(unit(random), unit(random), unit(random)));
    if (inside(p, 0.0)) points.push_back(p);
  }
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) - 0.5);
    const auto farthest = [&](const std::vector<glm::dvec3>& all) {
      double most = -1e30;
      for (const glm::dvec3& p : all) most = std::max(most, glm::dot(p, direction));
      return most;
    };
    EXPECT_LE(farthest(points), farthest(corners) + 1e-9);
    EXPECT_GE(farthest(points), farthest(corners) - 0.7);  // and the corners are no farther than the body
  }
}

TEST(MapOptionsCheck, NamesBothFlags) {
  EXPECT_NO_THROW(directionalParameterization().checkOptions({kCascades(4)}));
  EXPECT_NO_THROW(directionalParameterization().checkOptions({kWarp(Warp::Psm)}));
  for (const MapOptions& options :
       {MapOptions{kCascades(0)}, MapOptions{kCascades(5)}, MapOptions{kWarp(Warp::Tsm), kCascades(2)}}) {
    try {
      directionalParameterization().checkOptions(options);
      FAIL() << test::describe(options);
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("--cascades"), std::string::npos);
      if (options.get(kWarp) != Warp::None) {
        EXPECT_NE(std::string(error.what()).find("--warp tsm"), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
