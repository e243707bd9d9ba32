// Walks over meshes made by hand: each way to end, on each kind of light.
#include "scene/adjacency.h"

#include "shared/surface_bias.glsl"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using glm::vec3;
using namespace glsl;

// The light is at (0, 0, 4), or shines straight down; L has its origin there and the world's axes.
class Sheet {
 public:
  Sheet(bool positional, std::vector<vec3> positions, std::vector<uint32_t> indices) {
    const Adjacency adjacency = computeAdjacency(positions, indices);
    for (size_t i = 0; i < indices.size(); ++i)
      rows_.push_back({.corner = positions[indices[i]], .link = adjacency.links[i]});
    host_.rows = rows_.data();
    host_.isHole = [](const void* holes, uint triangle, uint, vec3) {
      return static_cast<uint>(reinterpret_cast<uintptr_t>(holes)) == triangle;
    };
    host_.scene = reinterpret_cast<const void*>(uintptr_t{0xffffffffu});
    tables_ = {.frame = {.originW = {0, 0, 4}, .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}},
               .positional = positional ? 1.0f : 0.0f,
               .endMargin = 4e-6f,
               .masked = 1,
               .host = &host_};
  }
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  void makeHole(uint triangle) { host_.scene = reinterpret_cast<const void*>(uintptr_t{triangle}); }

  // From the place of `start` that the light sees over (x, y) on z = `height`, to a receiver of triangle `own` that
  // faces the light.
  SheetWalk walk(uint start, vec3 from, vec3 target, uint own = 1000) const {
    return walkSheet(tables_, {.triangle = start}, inL(from), inL(target), {0, 0, 1}, {.triangle = own}, false);
  }
  const LookupTables& tables() const { return tables_; }
  vec3 inL(vec3 posW) const { return lightFromWorld(tables_.frame, posW); }

 private:
  std::vector<MeshRow> rows_;
  glsl::HostTables host_{};
  LookupTables tables_{};
};

// A strip of squares along x, one after another at the given heights, two triangles each; y from 0 to 1.
//   3-----5      triangles 0: (0 1 2), 1: (1 3 2), and so on: corners 2 i at y = 0, 2 i + 1 at y = 1
struct Strip {
  std::vector<vec3> positions;
  std::vector<uint32_t> indices;
  explicit Strip(const std::vector<glm::vec2>& profile) {  // x and z
    for (const glm::vec2& p : profile) {
      positions.emplace_back(p.x, 0.0f, p.y);
      positions.emplace_back(p.x, 1.0f, p.y);
    }
    for (uint32_t i = 0; i + 1 < profile.size(); ++i)
      for (const uint32_t corner : {2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 2, 2 * i + 3, 2 * i + 1})
        indices.push_back(corner);
  }
};

class SheetWalkTest : public ::testing::TestWithParam<bool> {};

TEST_P(SheetWalkTest, FindsTheTriangleThatShadows) {
  const Strip strip({{-1, 1}, {-0.5f, 1.1f}, {0, 1}, {0.5f, 1.2f}, {1, 1}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  // From either end to every square; the receiver lies on the floor, below.
  for (int step = 0; step < 40; ++step) {
    const vec3 over(-0.97f + 0.0485f * static_cast<float>(step), 0.3f, 1.0f);
    const vec3 floor = GetParam() ? vec3(0, 0, 4) + (over - vec3(0, 0, 4)) * (4.0f / 3.0f) : vec3(over.x, over.y, 0.0f);
    for (const auto& [start, from] : {std::pair(0u, vec3(-0.9f, 0.05f, 1)), std::pair(7u, vec3(0.9f, 0.95f, 1))}) {
      const SheetWalk walk = sheet.walk(start, from, floor);
      ASSERT_EQ(walk.end, kWalkWitness) << step << " " << start;
      EXPECT_LE(walk.steps, 8);
      // Its point lies on the receiver's own ray.
      const vec3 target = sheet.inL(floor);
      const vec3 across = GetParam() ? glm::cross(glm::normalize(target), walk.posL)
                                     : vec3(walk.posL.x - target.x, walk.posL.y - target.y, 0.0f);
      EXPECT_LT(glm::length(across), 1e-5f);
    }
  }
}

TEST_P(SheetWalkTest, EndsAtTheReceiversTriangle) {
  const Strip strip({{-1, 0}, {-0.5f, 0.4f}, {0, 0}, {0.5f, 0.4f}, {1, 0}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  for (uint32_t own = 0; own < 8; ++own) {
    const vec3 a = strip.positions[strip.indices[3 * own]], b = strip.positions[strip.indices[3 * own + 1]],
               c = strip.positions[strip.indices[3 * own + 2]];
    const SheetWalk walk = sheet.walk(0, {-0.9f, 0.05f, 0.08f}, (a + b + c) / 3.0f, own);
    EXPECT_EQ(walk.end, kWalkReceiver) << own;
    EXPECT_EQ(walk.steps, static_cast<int>(own)) << own;
  }
}

// The sheet goes on below the receiver.
TEST_P(SheetWalkTest, PassesBehindTheReceiver) {
  const Strip strip({{-1, 0}, {0, 0}, {1, 0}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 0}, {0.5f, 0.5f, 0.1f}).end, kWalkBehind);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 0}, {0.5f, 0.5f, -0.1f}).end, kWalkWitness);
}

TEST_P(SheetWalkTest, ClaimsNothingWithinTheMargin) {
  const Strip strip({{-1, 0}, {0, 0}, {1, 0}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  const float below = 2e-6f;  // half the end margin, and less than the rounding of coordinates about 4
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 0}, {0.5f, 0.5f, -below}).end, kWalkBehind);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 0}, {0.5f, 0.5f, -1e-3f}).end, kWalkWitness);
}

TEST_P(SheetWalkTest, SeesThroughHoles) {
  const Strip strip({{-1, 1}, {0, 1}, {1, 1}});
  Sheet sheet(GetParam(), strip.positions, strip.indices);
  const SheetWalk shadow = sheet.walk(0, {-0.9f, 0.05f, 1}, {0.5f, 0.3f, 0});
  EXPECT_EQ(shadow.end, kWalkWitness);
  sheet.makeHole(shadow.at.triangle);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 1}, {0.5f, 0.3f, 0}).end, kWalkHole);
}

TEST_P(SheetWalkTest, EndsAtABorder) {
  const Strip strip({{-1, 1}, {0, 1}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 1}, {0.8f, 0.5f, 0}).end, kWalkOpen);
}

// A Z: the first fold is a silhouette, though the sheet goes on below and would cover the receiver.
TEST_P(SheetWalkTest, EndsAtAFold) {
  const Strip strip({{-1, 2}, {0, 2}, {-0.5f, 1.5f}, {1.5f, 1}});
  const Sheet sheet(GetParam(), strip.positions, strip.indices);
  const SheetWalk walk = sheet.walk(0, {-0.9f, 0.05f, 2}, {0.7f, 0.5f, 0});
  EXPECT_EQ(walk.end, kWalkFold);
  EXPECT_LE(walk.steps, 2);
}

// A stair seen from straight above: its risers have no area, and the walk goes on over them.
TEST(SheetWalkOfASun, GoesOverTrianglesSeenEdgeOn) {
  const Strip strip({{-1, 2}, {0, 2}, {0, 1.5f}, {1, 1.5f}});
  const Sheet sheet(false, strip.positions, strip.indices);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 2}, {0.7f, 0.5f, 0}).end, kWalkWitness);
  EXPECT_EQ(sheet.walk(0, {-0.9f, 0.05f, 2}, {0.7f, 0.8f, 1.5f}, 5).end, kWalkReceiver);
}

// A texel's ray that passes outside its triangle, below: from there the line to the receiver would leave the sheet over
// the notch at corner 4; from the triangle's nearest point it passes above, and stays inside.
//
//        2
//       / \             triangles (0 1 2), where the walk begins; (1 0 3), (1 3 4), (1 4 5), (5 4 6), which covers
//      0---1---___       the receiver. The edges 3 4 and 4 6 are a border.
//       \  |\     --5
//        \ | 4----/
//         3    \ /
//               6
TEST_P(SheetWalkTest, BeginsOnTheTriangle) {
  const Sheet sheet(
      GetParam(), {{-1, 1.4f, 1}, {0, 1.4f, 1}, {-0.5f, 2, 1}, {0, 0.2f, 1}, {1, 0.5f, 1}, {2.5f, 1, 1}, {2, -0.5f, 1}},
      {0, 1, 2, 1, 0, 3, 1, 3, 4, 1, 4, 5, 5, 4, 6});
  const vec3 over(2, 0, 1);
  const vec3 floor = GetParam() ? vec3(0, 0, 4) + (over - vec3(0, 0, 4)) * (4.0f / 3.0f) : vec3(over.x, over.y, 0.0f);
  for (const float y : {1.5f, 1.2f, 1.0f}) {  // within, and below by more and more
    const SheetWalk walk = sheet.walk(0, {-0.5f, y, 1}, floor);
    EXPECT_EQ(walk.end, kWalkWitness) << y;
    EXPECT_EQ(walk.steps, 4) << y;
  }
}

// Where a sheet winds now one way and now the other, mirrored or not, nothing changes.
TEST_P(SheetWalkTest, DoesNotDependOnWinding) {
  const Strip strip({{-1, 1}, {-0.5f, 1.1f}, {0, 1}, {0.5f, 1.2f}, {1, 1}});
  const Sheet plain(GetParam(), strip.positions, strip.indices);
  for (int flips = 1; flips < 256; ++flips) {
    Strip turned = strip;
    for (uint32_t t = 0; t < 8; ++t)
      if ((flips >> t & 1) != 0) std::swap(turned.indices[3 * t + 1], turned.indices[3 * t + 2]);
    const Sheet sheet(GetParam(), turned.positions, turned.indices);
    for (const float x : {-0.7f, -0.2f, 0.3f, 0.8f}) {
      const SheetWalk a = plain.walk(0, {-0.9f, 0.05f, 1}, {x, 0.4f, 0}),
                      b = sheet.walk(0, {-0.9f, 0.05f, 1}, {x, 0.4f, 0});
      ASSERT_EQ(a.end, b.end) << flips << " " << x;
      ASSERT_EQ(a.steps, b.steps) << flips << " " << x;
    }
  }
}

// Two planes are exact on a valley and on a ridge, where adaptive's one fails on a valley.
TEST_P(SheetWalkTest, TwoPlanesLightBothSidesOfACrease) {
  for (const float height : {0.5f, -0.5f}) {  // of the crease over the ends
    const Strip strip({{-1, 0.5f - height}, {0, 0.5f}, {1, 0.5f - height}});
    const Sheet sheet(GetParam(), strip.positions, strip.indices);
    const vec3 normal = glm::normalize(vec3(height, 0, 1));
    for (const float x : {0.1f, 0.5f, 0.9f}) {
      const vec3 pointW(x, 0.5f, 0.5f - height * x);
      const vec3 texelW(-0.2f, 0.3f, 0.5f - height * 0.2f);
      const Ray ray{.origin = GetParam() ? vec3(0) : sheet.inL(texelW),
                    .dir = GetParam() ? glm::normalize(sheet.inL(texelW)) : vec3(0, 0, -1)};
      EXPECT_TRUE(twoPlaneLit(sheet.tables(), {.posL = sheet.inL(pointW), .normalL = normal}, {.triangle = 0}, ray));
      EXPECT_FALSE(twoPlaneLit(sheet.tables(), {.posL = sheet.inL(pointW - vec3(0, 0, 1)), .normalL = normal},
                               {.triangle = 0}, ray));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, SheetWalkTest, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Point" : "Sun"; });

}  // namespace
}  // namespace gnomon
