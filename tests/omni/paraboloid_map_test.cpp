// shared/paraboloid_map.glsl and paraboloid_bound.glsl: round trips, the rim, bounds against brute force, and
// the same answers on both processors.
#include "omni/paraboloid_map.h"

#include "omni_fixture.h"
#include "omni_functions.glsl"
#include "tests/run_kernel.h"

#include "shared/paraboloid_pieces.glsl"

#include <algorithm>
#include <array>

namespace gnomon {
namespace {

using namespace glsl;

FittedMap paraboloid(int side = 256) {
  return makeParaboloidMap({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, ParaboloidRaster::Exact, 0.05, 20.0, side, 30.0f);
}

std::vector<RoundTripQuery> queriesAllAround(const FittedMap& fitted, size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<RoundTripQuery> queries(count);
  for (size_t i = 0; i < count; ++i) {
    vec3 dir = test::randomDirection(random);
    // Every 16th at the rim or a hair beside it.
    if (i % 16 == 0) dir.z = i % 32 == 0 ? 0.0f : dir.z * 1e-7f;
    queries[i].posL = dir * (0.1f + 19.0f * unit(random));
    queries[i].depth = mapDepth(fitted.map, 0, queries[i].posL);
  }
  return queries;
}

TEST(ParaboloidMap, APointComesBackToItsUvAndItsDepthToItsDistance) {
  const FittedMap fitted = paraboloid();
  for (const RoundTripQuery& query : queriesAllAround(fitted, size_t{1} << 20)) {
    const RoundTrip answer = roundTrip(fitted.map, query);
    ASSERT_EQ(answer.covered, 1);
    ASSERT_TRUE(mapHoldsTexel(fitted.map, answer.slice, mapTexel(fitted.map, answer.uv)));
    if (answer.sliceAgain == answer.slice) {
      ASSERT_NEAR(answer.uvAgain.x, answer.uv.x, 3.6e-7f);  // six roundings of 2^-24
      ASSERT_NEAR(answer.uvAgain.y, answer.uv.y, 3.6e-7f);
    } else {
      ASSERT_NEAR(length(answer.uv * 2.0f - 1.0f), 1.0f, 1e-6f);  // on the rim
    }
    ASSERT_NEAR(length(answer.dir), 1.0f, 3e-7f);
    // One rounding of depth is 2^-24 / slope metres.
    const float along = length(query.posL) - fitted.map.zNear;
    ASSERT_NEAR(answer.distance, along, 8.0f * 5.97e-8f / answer.slope);
    ASSERT_NEAR(dot(answer.dir, query.posL) / length(query.posL), 1.0f, 1e-6f);
  }
}

// The erratum of Dou et al. 2014: their R is not unit. Its direction is right.
TEST(ParaboloidMap, TheTexelsRayIsTheirRMadeUnit) {
  const FittedMap fitted = paraboloid();
  for (float x = -0.9f; x < 1.0f; x += 0.1f) {
    for (float y = -0.9f; y < 1.0f; y += 0.1f) {
      const Ray ray = mapTexelRay(fitted.map, 1, vec2(0.5f + 0.5f * x, 0.5f - 0.5f * y));
      const vec3 paper = vec3(x, y, (1.0f - x * x - y * y) / 2.0f);
      EXPECT_LT(length(ray.dir - normalize(paper)), 1e-6f);
    }
  }
}

// The ray that is not unit, with which exact triangles are drawn (omni/draw_in_paraboloid.frag.glsl), meets a plane as
// near to where it is met as the unit one does: against doubles, in units of 2^-24 of the distance.
TEST(ParaboloidMap, TheDrawnRayMeetsAPlaneAsExactlyAsTheUnitRay) {
  const FittedMap fitted = paraboloid(1774);
  const vec4 numbers = mapDrawnNumbers(fitted.map);
  std::mt19937 random(3);
  std::uniform_int_distribution<int> texel(0, fitted.map.width - 1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  double drawnSum = 0.0, unitSum = 0.0, drawnWorst = 0.0, unitWorst = 0.0;
  size_t met = 0;
  for (int i = 0; i < 1 << 18; ++i) {
    const int slice = i & 1;
    const vec2 center(static_cast<float>(texel(random)) + 0.5f, static_cast<float>(texel(random)) + 0.5f);
    if (!mapHoldsTexelAt(fitted.map, center)) continue;
    const vec3 normal = test::randomDirection(random) / (0.1f + 10.0f * unit(random));
    const dvec2 at = dvec2(center) * (2.0 / 1774.0) - 1.0;
    const double square = dot(at, at);
    const dvec3 dir = dvec3(2.0 * at.x, -2.0 * at.y, (slice == 0 ? -1.0 : 1.0) * (1.0 - square)) / (1.0 + square);
    const double cosine = dot(dvec3(normal), dir);
    if (cosine < 0.05 * length(normal)) continue;  // behind, or so flat that both are far off
    const ParaboloidDrawnRay drawn = paraboloidDrawnRay(numbers, slice, center);
    const float drawnAlong = drawn.size / dot(normal, drawn.dir);
    const Ray ray = mapTexelRay(fitted.map, slice, center / mapTexelCounts(fitted.map));
    const float unitAlong = length(ray.dir * (1.0f / dot(normal, ray.dir)));
    const auto offBy = [&](float along) { return std::abs(along * cosine - 1.0) * 16777216.0; };
    drawnSum += offBy(drawnAlong);
    unitSum += offBy(unitAlong);
    drawnWorst = std::max(drawnWorst, offBy(drawnAlong));
    unitWorst = std::max(unitWorst, offBy(unitAlong));
    ++met;
    if (unitAlong > fitted.map.zFar) continue;
    ASSERT_NEAR(paraboloidDrawnDepth(numbers, unitAlong), mapDepth(fitted.map, slice, ray.dir * unitAlong), 3.6e-7f);
  }
  ASSERT_GT(met, 60000u);
  EXPECT_LE(drawnSum, unitSum) << drawnSum / static_cast<double>(met) << " against "
                               << unitSum / static_cast<double>(met);
  EXPECT_LE(drawnWorst, 1.25 * unitWorst) << drawnWorst << " against " << unitWorst;
}

TEST(ParaboloidMap, TexelsOutsideTheDiscAreNotHeldAndThoseItTouchesAre) {
  for (const int side : {2, 3, 16, 255, 1024}) {
    const FittedMap fitted = paraboloid(side);
    int wrong = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        // The nearest point of the texel to the centre, in double.
        const double cx = std::clamp(side / 2.0, double(x), x + 1.0) - side / 2.0;
        const double cy = std::clamp(side / 2.0, double(y), y + 1.0) - side / 2.0;
        const double reach = std::hypot(cx, cy) / (side / 2.0);
        if (std::abs(reach - 1.0) < 1e-5) continue;
        wrong += mapHoldsTexel(fitted.map, 0, {x, y}) != (reach < 1.0) ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << side;
    EXPECT_EQ(mapHoldsTexel(fitted.map, 0, {-1, side / 2}), false);
    EXPECT_EQ(mapHoldsTexel(fitted.map, 2, {side / 2, side / 2}), false);
  }
}

// What answers for a texel beyond the rim that nobody draws is a texel whose ray is as near to the missing
// one's as any.
TEST(ParaboloidMap, ATapBeyondTheRimLandsOnTheTexelWhoseRayIsNearest) {
  constexpr int kSide = 32;
  const FittedMap fitted = paraboloid(kSide);
  size_t taps = 0;
  for (int slice = 0; slice < 2; ++slice) {
    for (int y = -1; y <= kSide; ++y) {
      for (int x = -1; x <= kSide; ++x) {
        const bool besideHeld =
            mapHoldsTexel(fitted.map, slice, {x - 1, y}) || mapHoldsTexel(fitted.map, slice, {x + 1, y}) ||
            mapHoldsTexel(fitted.map, slice, {x, y - 1}) || mapHoldsTexel(fitted.map, slice, {x, y + 1});
        if (mapHoldsTexel(fitted.map, slice, {x, y}) || !besideHeld) continue;
        ++taps;
        const vec3 wanted = mapTexelRay(fitted.map, slice, mapTexelCenter(fitted.map, {x, y})).dir;
        const MapTexel found = mapTexelAcross(fitted.map, slice, {x, y}, wanted * 3.0f);
        ASSERT_TRUE(found.held);
        EXPECT_EQ(found.slice, 1 - slice);
        ASSERT_TRUE(mapHoldsTexel(fitted.map, found.slice, found.texel));
        const vec3 got = mapTexelRay(fitted.map, found.slice, mapTexelCenter(fitted.map, found.texel)).dir;
        // At the rim a texel is 2/side radians across, half a diagonal 0.71 of that.
        EXPECT_LT(length(wanted - got), 0.75f * 2.0f / kSide);
      }
    }
  }
  EXPECT_GT(taps, 150u);
}

bool isInsideQuad(const QuadBound& bound, dvec2 p) {
  const std::array<dvec2, 4> q = {dvec2(bound.p0), dvec2(bound.p1), dvec2(bound.p2), dvec2(bound.p3)};
  if (q[0] == q[1] && q[1] == q[2]) return false;
  bool left = true, right = true;
  for (int i = 0; i < 4; ++i) {
    const dvec2 e = q[(i + 1) % 4] - q[i], d = p - q[i];
    const double side = e.x * d.y - e.y * d.x;
    left = left && side >= 0.0;
    right = right && side <= 0.0;
  }
  return left || right;
}

// The bounds that bound_in_paraboloid.comp.glsl finds for a triangle.
std::vector<QuadBound> boundsOf(int side, int slice, const LightTriangle& triangle) {
  std::vector<QuadBound> bounds;
  const Piece whole{.a = triangle.a, .b = triangle.b, .c = triangle.c, .uvA = {}, .uvB = {}, .uvC = {}};
  std::vector<Piece> waiting = {whole};
  while (!waiting.empty()) {
    const Piece piece = waiting.back();
    waiting.pop_back();
    const QuadBound bound = paraboloidBound(side, slice, lightTriangle(piece.a, piece.b, piece.c));
    if (waiting.size() < size_t{kMostWaiting} && isWorthHalving(side, slice, piece, bound)) {
      const PieceHalves halves = halvesOf(side, slice, piece, false);
      waiting.insert(waiting.end(), {halves.second, halves.first});
    } else {
      bounds.push_back(bound);
    }
  }
  return bounds;
}

// Triangles of every size and place: specks, slivers, some across the rim, around the light, nearly through
// it, touching it.
std::vector<std::array<vec3, 3>> trianglesOfAllKinds(size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto anywhere = [&] { return vec3(unit(random), unit(random), unit(random)); };
  std::vector<std::array<vec3, 3>> triangles(count);
  for (size_t i = 0; i < count; ++i) {
    const vec3 center = anywhere() * 3.0f;
    const float size = std::pow(10.0f, 1.5f * unit(random));
    std::array<vec3, 3>& t = triangles[i];
    for (vec3& corner : t) corner = center + anywhere() * size;
    switch (i % 8) {
      case 1:  // a sliver
        t[2] = mix(t[0], t[1], 0.4f) + anywhere() * (0.001f * size);
        break;
      case 2:  // nearly through the light
        t[2] = -(t[0] + t[1]) + anywhere() * 1e-4f;
        break;
      case 3:  // a corner at the rim
        t[1].z = 0.0f;
        break;
      case 4:  // an edge along the rim
        t[0].z = t[1].z = 0.0f;
        break;
      case 5:  // touches the light
        t[0] = vec3(0.0f);
        break;
      case 6:  // an edge that passes over the pole
        t[1] = vec3(-t[0].x, -t[0].y, t[0].z);
        break;
      default:
        break;
    }
  }
  return triangles;
}

TEST(ParaboloidBound, EnclosesEveryTexelWhoseRayMeetsTheTriangle) {
  // Large enough for pieces; every other texel each way is asked.
  constexpr int kSide = 256;
  const FittedMap fitted = paraboloid(kSide);
  size_t met = 0, missed = 0, enclosed = 0, across = 0, cut = 0;
  const auto triangles = trianglesOfAllKinds(800);
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const bool ordinary = i % 8 == 0 || i % 8 == 7;
    const LightTriangle triangle = lightTriangle(a, b, c);
    const vec3 normal = inversePlaneNormal(triangle);
    for (int slice = 0; slice < 2; ++slice) {
      const std::vector<QuadBound> bounds = boundsOf(kSide, slice, triangle);
      cut += bounds.size() > 1 ? 1 : 0;
      size_t here = 0;
      for (int y = static_cast<int>(i) & 1; y < kSide; y += 2) {
        for (int x = static_cast<int>(i) >> 1 & 1; x < kSide; x += 2) {
          if (!mapHoldsTexel(fitted.map, slice, {x, y})) continue;
          const vec2 uv = mapTexelCenter(fitted.map, {x, y});
          const auto inside = std::ranges::count_if(bounds, [&](const QuadBound& bound) {
            return isInsideQuad(bound, {2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y});
          });
          enclosed += ordinary ? static_cast<size_t>(inside) : 0;
          const vec3 dir = mapTexelRay(fitted.map, slice, uv).dir;
          const vec3 distances = sideDistances(triangle, dir);
          if (!isWithin(distances) || !(1.0f / dot(normal, dir) >= fitted.map.zNear)) continue;
          ++here;
          missed += inside > 0 ? 0 : 1;
        }
      }
      met += ordinary ? here : 0;
      across += here > 0 && (a.z * b.z < 0.0f || b.z * c.z < 0.0f) ? 1 : 0;
    }
  }
  EXPECT_EQ(missed, 0u);
  EXPECT_GT(across, 125u);
  EXPECT_GT(cut, 125u);
  EXPECT_LT(enclosed, 5 * met / 2);  // and little more than it must
}

// Two triangles on both sides of an edge leave no direction between them, and directions within both are
// those on the edge.
TEST(RayTriangle, NoRaySlipsBetweenTrianglesThatShareAnEdge) {
  std::mt19937 random(13);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto anywhere = [&] {
    vec3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = unit(random);  // in this order under every compiler
    return v;
  };
  size_t between = 0, on = 0;
  for (int i = 0; i < 200000; ++i) {
    const vec3 center = vec3(0, 0, -3) + anywhere();
    const float size = std::pow(10.0f, 2.0f * unit(random) - 2.0f);
    const vec3 a = center + anywhere() * size;
    const vec3 b = center + anywhere() * size;
    const LightTriangle left = lightTriangle(a, b, center + vec3(-2, 0, 0)),
                        right = lightTriangle(b, a, center + vec3(2, 0, 0));
    const float t = 0.5f + 0.49f * unit(random);
    // Coordinates of up to 5 m round by 5e-7, three times on the way to a direction: nearer than that to an
    // end of the edge a direction may pass it by.
    if (std::min(t, 1.0f - t) * length(b - a) < 2e-6f) continue;
    // On the edge, to within rounding.
    const vec3 dir = normalize(mix(a, b, t));
    const bool inLeft = isWithin(sideDistances(left, dir)), inRight = isWithin(sideDistances(right, dir));
    if ((left.volume < 0.0f) != (right.volume < 0.0f)) continue;  // both on one side of the edge
    // Nor slivers, whose other sides pass within rounding of this one.
    if (std::min(std::abs(left.volume), std::abs(right.volume)) < 0.1f * length(a - b)) continue;
    between += !inLeft && !inRight ? 1 : 0;
    on += inLeft != inRight ? 1 : 0;
  }
  EXPECT_EQ(between, 0u);
  EXPECT_GT(on, 50000u);
}

TEST(SeamAvoidingAxis, TurnsTheSeamAcrossTheReceivers) {
  std::mt19937 random(17);
  for (int i = 0; i < 20; ++i) {
    const dvec3 main = dvec3(test::randomDirection(random));
    std::vector<dvec3> receivers;
    for (int k = 0; k < 5000; ++k)
      receivers.push_back(dvec3(1, 2, 3) + 4.0 * normalize(main + 0.5 * dvec3(test::randomDirection(random))));
    const dvec3 axis = seamAvoidingAxis({1, 2, 3}, receivers);
    EXPECT_GT(dot(axis, main), 0.97);
    EXPECT_EQ(axis, seamAvoidingAxis({1, 2, 3}, receivers));
  }
  EXPECT_EQ(seamAvoidingAxis({1, 2, 3}, {}), dvec3(0, -1, 0));
}

class ParaboloidMapOnTheGpu : public gpu::GpuTest {};

TEST_F(ParaboloidMapOnTheGpu, AMillionRoundTripsEqualTheCpuBitForBit) {
  const FittedMap fitted = paraboloid();
  const std::vector<RoundTripQuery> queries = queriesAllAround(fitted, size_t{1} << 20);
  const gpu::Buffer map = gpu::createBufferWith(
      device(), "map", std::vector<MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
      VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  const auto answers = gpu::runKernel<RoundTripQuery, RoundTrip>(
      device(), GNOMON_TEST_SHADER("evaluate_round_trip.comp.glsl"), queries, {{kBindMap, map}});
  const test::RoundTripDifference difference =
      test::compareRoundTrips(answers, queries, fitted.map, [&](float a, float b) { return apart(a, b); });
  EXPECT_LE(difference.worst, apartAtMost());
  EXPECT_LE(difference.elsewhere, isLavapipe() ? 0 : queries.size() / 16);  // those on the rim
}

}  // namespace
}  // namespace gnomon
