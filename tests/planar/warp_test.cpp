// Warps against their papers' own claims, and the one idea all stand on: that each is a matrix on the plane
// of light rays.
#include "planar/warp.h"
#include "judge/texel_density.h"
#include "planar/convex_body.h"
#include "tests/shadow/map_fixture.h"
#include "tests/shadow/seen_scene.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

using test::SeenScene;

constexpr Warp kWarps[] = {Warp::Psm, Warp::Lispsm, Warp::Tsm};

SeenScene seeLongFloor(double elevation, double azimuth) {
  return test::see(test::longFloor(), test::alongTheFloor(), test::sun(elevation, azimuth), 96);
}

glm::dvec2 uvOf(const FittedMap& fitted, const glm::dvec3& posW) {
  const glsl::MapPoint point = glsl::mapProject(fitted.map, glsl::lightFromWorld(fitted.frame, glm::vec3(posW)));
  EXPECT_TRUE(point.covered);
  return glm::dvec2(point.uv);
}

double wOf(const FittedMap& fitted, const glm::dvec3& posW) {
  const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(posW));
  return static_cast<double>(glsl::transform(fitted.map.mapSlices[0].clipFromLight, glm::vec4(posL, 1.0f)).w);
}

// Bounds of the receivers' images to [0,1]^2.
std::vector<glm::dvec2> normalized(std::vector<glm::dvec2> points) {
  const Window box = windowOf(points);
  for (glm::dvec2& p : points) p = (p - box.lower) / (box.upper - box.lower);
  return points;
}

struct ViewDepths {
  double nearest = 1e30, farthest = 0.0;
};
ViewDepths viewDepths(const SeenScene& seen) {
  ViewDepths depths;
  for (const glm::dvec3& p : seen.scored) {
    depths.nearest = std::min(depths.nearest, viewDepth(seen.view, p));
    depths.farthest = std::max(depths.farthest, viewDepth(seen.view, p));
  }
  return depths;
}

// The paper's construction step by step, with matrices of other make: the camera's perspective, then a camera
// at the image of the light that looks at the middle of the unit cube, then the bounds of what it sees.
void expectLiteralPsm(const SeenScene& seen, const FittedMap& fitted, const glm::dvec4& lightW) {
  const ViewDepths depths = viewDepths(seen);
  const glm::dvec3 eye(seen.view.eyeW);
  const glm::dmat4 camera = glm::perspectiveRH_ZO(2.0 * std::atan(static_cast<double>(seen.view.tanHalfY)), 1.0,
                                                  depths.nearest, depths.farthest) *
                            glm::lookAtRH(eye, eye + glm::dvec3(seen.view.forwardW), glm::dvec3(seen.view.upW));
  const glm::dvec4 q = camera * lightW;
  ASSERT_GT(std::abs(q.w), 1e-3);
  const glm::dmat4 look = glm::lookAtRH(glm::dvec3(q) / q.w, glm::dvec3(0, 0, 0.5), glm::dvec3(0, 0, 1));
  std::vector<glm::dvec2> literal, ours;
  for (const glm::dvec3& receiver : seen.scored) {
    const glm::dvec4 p = camera * glm::dvec4(receiver, 1.0);
    const glm::dvec4 l = look * (p / p.w);
    literal.push_back(glm::dvec2(l) / -l.z);
    ours.push_back(uvOf(fitted, receiver));
  }
  literal = normalized(literal);
  ours = normalized(ours);
  // A map may be mirrored against another along either axis.
  for (int axis = 0; axis < 2; ++axis) {
    double same = 0.0, mirrored = 0.0;
    for (size_t i = 0; i < ours.size(); ++i) {
      same = std::max(same, std::abs(ours[i][axis] - literal[i][axis]));
      mirrored = std::max(mirrored, std::abs(ours[i][axis] - 1.0 + literal[i][axis]));
    }
    // Ours went through floats: kMostWarp's derivation, 1.5e-5, once for the point and once for the bounds.
    EXPECT_LT(std::min(same, mirrored), 3e-5) << axis;
  }
}

TEST(Psm, IsThePapersCompositionForASun) {
  for (const double azimuth : {35.0, 130.0}) {  // before and behind the camera
    const SeenScene seen = seeLongFloor(60.0, azimuth);
    const FittedMap fitted = seen.fit(directionalParameterization(), {kWarp(Warp::Psm)});
    ASSERT_EQ(fitted.note, "");
    expectLiteralPsm(seen, fitted, glm::dvec4(-seen.light.directionW, 0.0));
  }
}

TEST(Psm, IsThePapersCompositionForASpotLight) {
  const LightModel spot{.type = LightType::Spot,
                        .positionW = {12.0, 30.0, 20.0},
                        .directionW = glm::normalize(glm::dvec3(-12.0, -30.0, 10.0)),
                        .outerConeRad = 0.6};
  const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), spot, 96);
  const FittedMap fitted = seen.fit(spotParameterization(), {kWarp(Warp::Psm)});
  ASSERT_EQ(fitted.note, "");
  expectLiteralPsm(seen, fitted, glm::dvec4(spot.positionW, 1.0));
}

// With the light across the view W is, up to a factor, the distance along the view from the projection
// centre: that of PSM is the eye; LiSPSM's stands sqrt(n f) behind it.
TEST(Lispsm, StandsTheRootOfNearTimesFarBehindTheEye) {
  const SeenScene seen = test::see(test::longFloor(), lookAt("level", {0.2f, 1.7f, 55.0f}, {0.2f, 1.7f, 45.0f}, 0.9f),
                                   test::sun(90.0, 90.0), 96);
  const ViewDepths depths = viewDepths(seen);
  const double behind = std::sqrt(depths.nearest * depths.farthest);
  const FittedMap lispsm = seen.fit(directionalParameterization(), {kWarp(Warp::Lispsm)});
  const FittedMap psm = seen.fit(directionalParameterization(), {kWarp(Warp::Psm)});
  ASSERT_EQ(lispsm.note + psm.note, "");
  const auto at = [&](double depth) {
    return glm::dvec3(seen.view.eyeW) + depth * glm::dvec3(seen.view.forwardW) - glm::dvec3(0, 1.5, 0);
  };
  for (const double share : {0.1, 0.4, 0.9}) {
    const double depth = glm::mix(depths.nearest, depths.farthest, share);
    EXPECT_NEAR(wOf(lispsm, at(depth)) / wOf(lispsm, at(depths.nearest)), (depth + behind) / (depths.nearest + behind),
                1e-3);
    EXPECT_NEAR(wOf(psm, at(depth)) / wOf(psm, at(depths.nearest)), depth / depths.nearest, 1e-3);
  }
}

// The share of a TSM's length that the nearer half of what is seen fills.
double filledByTheNearerHalf(const SeenScene& seen, const FittedMap& fitted) {
  std::vector<double> along;
  for (const glm::dvec3& receiver : seen.scored) along.push_back(uvOf(fitted, receiver).y);
  // Which end is near: W is small there.
  const auto [first, last] = std::ranges::minmax_element(along);
  if (wOf(fitted, seen.scored[static_cast<size_t>(first - along.begin())]) >
      wOf(fitted, seen.scored[static_cast<size_t>(last - along.begin())]))
    for (double& v : along) v = 1.0 - v;
  std::ranges::sort(along);
  return along[along.size() / 2];
}

// The 80% rule, with the focus that warp.cpp chooses: half of the receivers before the line. W would vary more than
// kMostWarp in a view along the floor, half of whose pixels see a twentieth of its length; looking down at it, it does
// not.
TEST(Tsm, HalfOfWhatIsSeenFillsFourFifthsOfTheMap) {
  const Camera down = lookAt("down at the floor", {0.2f, 6.0f, 55.0f}, {0.2f, 0.0f, 45.0f}, 0.7f);
  for (const double azimuth : {0.0, 90.0, 140.0}) {
    const SeenScene seen = test::see(test::longFloor(), down, test::sun(55.0, azimuth), 96);
    const FittedMap fitted = seen.fit(directionalParameterization(), {kWarp(Warp::Tsm)}, 1024);
    ASSERT_EQ(fitted.note, "") << azimuth;
    // Half a texel of 1024 to the square's edge, and as much again for the receiver beside the middle one.
    EXPECT_NEAR(filledByTheNearerHalf(seen, fitted), 0.8, 1e-3) << azimuth;

    const SeenScene longView = seeLongFloor(55.0, azimuth);
    const FittedMap weakened = longView.fit(directionalParameterization(), {kWarp(Warp::Tsm)}, 1024);
    ASSERT_NE(weakened.note.find("weakened"), std::string::npos) << weakened.note;
    EXPECT_LT(filledByTheNearerHalf(longView, weakened), 0.75) << azimuth;
  }
}

TEST(Warp, RaisesTheDensityNearTheCameraOfALongView) {
  const SeenScene seen = seeLongFloor(50.0, 60.0);
  // The quarter of the pixels nearest to the camera, and the farthest.
  std::vector<double> depths;
  for (const glm::dvec3& p : seen.scored) depths.push_back(viewDepth(seen.view, p));
  std::ranges::sort(depths);
  const double nearer = depths[depths.size() / 4];
  const double farther = depths[3 * depths.size() / 4];
  const auto medianWhere = [&](const FittedMap& fitted, const auto& wanted) {
    std::vector<float> densities = texelDensities(fitted, seen.receivers);
    for (size_t i = 0; i < densities.size(); ++i)
      if (!wanted(viewDepth(seen.view, seen.receivers.samples[i].positionW))) densities[i] = -1.0f;
    return medianDensity(densities);
  };
  const auto isNear = [&](double depth) { return depth < nearer; };
  const auto isFar = [&](double depth) { return depth > farther; };
  const FittedMap plain = seen.fit(directionalParameterization(), {}, 1024);
  for (const Warp warp : kWarps) {
    const FittedMap warped = seen.fit(directionalParameterization(), {kWarp(warp)}, 1024);
    const double gain = medianWhere(warped, isNear) / medianWhere(plain, isNear);
    const double loss = medianWhere(warped, isFar) / medianWhere(plain, isFar);
    EXPECT_GT(gain, 10.0) << kWarp.text(warp);
    EXPECT_GT(gain, 4.0 * loss) << kWarp.text(warp);
  }
}

TEST(Warp, IsNotAppliedWhereTheLightShinesAlongTheViewAndSaysSo) {
  SeenScene seen = seeLongFloor(50.0, 60.0);
  seen.light.directionW = glm::dvec3(seen.view.forwardW);
  const FittedMap plain = seen.fit(directionalParameterization(), {kSnap(false)});
  for (const Warp warp : {Warp::Lispsm, Warp::Tsm}) {
    const FittedMap fitted = seen.fit(directionalParameterization(), {kSnap(false), kWarp(warp)});
    EXPECT_NE(fitted.note.find("not applied"), std::string::npos) << fitted.note;
    EXPECT_EQ(uvOf(fitted, seen.scored.front()), uvOf(plain, seen.scored.front()));
  }
}

TEST(Warp, OfALightAmongWhatIsSeenCoversAllOfItAndSaysWhatItCost) {
  std::string notes;
  for (const glm::dvec3& direction :
       {glm::dvec3(0.0, -1.0, 0.2), glm::dvec3(0.0, -0.3, 1.0), glm::dvec3(0.0, -0.3, -1.0), glm::dvec3(1, -0.3, 0)}) {
    const LightModel spot{.type = LightType::Spot,
                          .positionW = {0.2, 1.5, 48.0},
                          .directionW = glm::normalize(direction),
                          .outerConeRad = 1.4};
    const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), spot, 96);
    for (const Warp warp : kWarps) {
      const FittedMap fitted = seen.fit(spotParameterization(), {kWarp(warp)});
      notes += fitted.note + "\n";
      ASSERT_FALSE(seen.scored.empty());
      for (const glm::dvec3& receiver : seen.scored) uvOf(fitted, receiver);  // covered
    }
  }
  // PSM's camera is moved back from one of the four lights and warps nothing for another; TSM is weakened for one.
  for (const char* note : {"psm: the virtual camera is", "psm: not applied, the light is among", "tsm: weakened"})
    EXPECT_NE(notes.find(note), std::string::npos) << note << " is not among " << notes;
}

// However the sun stands, W stays within what kMostWarp allows, and no slice is mirrored: culling relies on it.
TEST(Warp, KeepsItsRatioAndItsHandAtEveryAngle) {
  for (const double elevation : {8.0, 30.0, 60.0, 90.0}) {
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
      const SeenScene seen =
          test::see(test::longFloor(), test::alongTheFloor(), test::sun(elevation, static_cast<double>(azimuth)), 24);
      for (const Warp warp : kWarps) {
        const FittedMap fitted = seen.fit(directionalParameterization(), {kWarp(warp)}, 64);
        double least = 1e30, most = 0.0;
        for (const glm::vec2& uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
          const glsl::Ray ray = glsl::mapTexelRay(fitted.map, 0, uv);
          const double w = static_cast<double>(
              glsl::transform(fitted.map.mapSlices[0].clipFromLight, glm::vec4(ray.origin, 1.0f)).w);
          least = std::min(least, w);
          most = std::max(most, w);
        }
        EXPECT_GT(least, 0.0) << kWarp.text(warp) << elevation << " " << azimuth;
        EXPECT_LT(most, kMostWarp * 1.001 * least) << kWarp.text(warp) << elevation << " " << azimuth;
        const auto origin = [&](float u, float v) { return glsl::mapTexelRay(fitted.map, 0, {u, v}).origin; };
        // v runs down in the picture: right x down is along the light's view.
        const glm::vec3 turn =
            glm::cross(origin(0.51f, 0.5f) - origin(0.5f, 0.5f), origin(0.5f, 0.51f) - origin(0.5f, 0.5f));
        EXPECT_LT(turn.z, 0.0f) << kWarp.text(warp) << elevation << " " << azimuth;
      }
    }
  }
}

TEST(ConvexHull, HoldsAllPointsAndTurnsLeft) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(normal(random), normal(random));
  const std::vector<glm::dvec2> hull = convexHull(points);
  ASSERT_GE(hull.size(), 3u);
  EXPECT_LT(hull.size(), 60u);
  for (size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 a = hull[i];
    const glm::dvec2 ab = hull[(i + 1) % hull.size()] - a;
    for (const glm::dvec2& p : points) EXPECT_GE(ab.x * (p.y - a.y) - ab.y * (p.x - a.x), -1e-12);
  }
  EXPECT_EQ(convexHull({{1, 2}, {1, 2}, {1, 2}}).size(), 1u);
}

}  // namespace
}  // namespace gnomon
