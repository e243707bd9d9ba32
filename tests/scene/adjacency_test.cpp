// Neighbours across edges: closed meshes, seams that a file splits, and what no mesh should have but many do.
#include "scene/adjacency.h"
#include "scene/generate.h"
#include "scene/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using glsl::kNoLink;
using glsl::linkedRow;
using glsl::linkedTriangle;
using glsl::linkTurns;

Adjacency adjacencyOf(const Mesh& mesh) {
  return computeAdjacency(mesh.positions, mesh.indices);
}

// What every link must be: mutual, across one edge, turned where the two wind alike.
void expectMutual(const Mesh& mesh, const Adjacency& adjacency) {
  const auto corner = [&](uint32_t triangle, int k) {
    return mesh.positions[mesh.indices[3 * triangle + static_cast<uint32_t>(k % 3)]];
  };
  for (uint32_t half = 0; half < adjacency.links.size(); ++half) {
    const uint32_t link = adjacency.links[half];
    if (link == kNoLink) continue;
    const uint32_t own = half / 3, other = linkedTriangle(link);
    const int row = static_cast<int>(half % 3), back = linkedRow(link);
    ASSERT_LT(other, adjacency.links.size() / 3);
    ASSERT_NE(other, own);
    const glm::vec3 a = corner(own, row + 1), b = corner(own, row + 2);
    const glm::vec3 c = corner(other, back + 1), d = corner(other, back + 2);
    ASSERT_TRUE(linkTurns(link) ? a == c && b == d : a == d && b == c) << half;
  }
}

Mesh meshOf(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.indices = std::move(indices);
  return mesh;
}

// A square of two triangles in the plane z = 0.
const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(Adjacency, OfClosedMeshesHasNoOpenEdge) {
  size_t closed = 0;
  for (const char* name : {"contact", "lshape", "double-torus", "atrium", "factory"}) {
    const Scene scene = openScene(name);
    for (const Mesh& mesh : scene.meshes) {
      const Adjacency adjacency = adjacencyOf(mesh);
      expectMutual(mesh, adjacency);
      if (!mesh.closed) continue;
      ++closed;
      EXPECT_EQ(adjacency.openEdges, 0u) << name << " " << mesh.name;
      EXPECT_EQ(adjacency.nonManifoldEdges, 0u) << name << " " << mesh.name;
      EXPECT_TRUE(
          std::ranges::none_of(adjacency.links, [](uint32_t link) { return link != kNoLink && linkTurns(link); }))
          << name << " " << mesh.name;
    }
  }
  EXPECT_GT(closed, 20u);
}

TEST(Adjacency, WeldsSeamsAndMinusZero) {
  // The diagonal's corners occur twice, once as -0.
  const Mesh mesh =
      meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0f, 0, -0.0f}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3, 4, 5});
  const Adjacency adjacency = adjacencyOf(mesh);
  EXPECT_EQ(adjacency.openEdges, 4u);
  EXPECT_EQ(adjacency.sheets, 1u);
  EXPECT_EQ(adjacency.links[1], glsl::packLink(1, false, 2));
  EXPECT_EQ(adjacency.links[5], glsl::packLink(0, false, 1));
}

TEST(Adjacency, SurvivesTrianglesWithoutArea) {
  const Mesh mesh = meshOf(kSquare, {0, 1, 2, 0, 2, 2, 1, 1, 1, 0, 2, 3});
  const Adjacency adjacency = adjacencyOf(mesh);
  EXPECT_EQ(adjacency.openEdges, 4u);
  EXPECT_EQ(linkedTriangle(adjacency.links[1]), 3u);
  for (const uint32_t triangle : {1u, 2u}) {
    EXPECT_EQ(adjacency.sheetOf[triangle], kNoSheet);
    for (uint32_t row = 0; row < 3; ++row) EXPECT_EQ(adjacency.links[3 * triangle + row], kNoLink);
  }
  EXPECT_EQ(adjacency.sheets, 1u);
}

// A face that stands twice, and once turned over: the sheet goes on as if it stood once.
TEST(Adjacency, SurvivesFacesThatStandTwice) {
  const Mesh mesh = meshOf(kSquare, {0, 1, 2, 0, 2, 3, 2, 0, 1, 3, 2, 0});
  const Adjacency adjacency = adjacencyOf(mesh);
  expectMutual(mesh, adjacency);
  EXPECT_EQ(adjacency.nonManifoldEdges, 0u);
  EXPECT_EQ(adjacency.openEdges, 4u);
  EXPECT_EQ(adjacency.sheets, 1u);
  EXPECT_EQ(linkedTriangle(adjacency.links[1]), 1u);
  EXPECT_EQ(linkedTriangle(adjacency.links[6 + 2]), 1u);  // of the copy 2 0 1, opposite to its corner 1
  EXPECT_EQ(linkedTriangle(adjacency.links[9 + 0]), 0u);  // of 3 2 0, which is 0 2 3 turned over
  EXPECT_TRUE(linkTurns(adjacency.links[9 + 0]));
}

TEST(Adjacency, LeavesEdgesOfThreeTrianglesAlone) {
  const Mesh mesh = meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {0, 1, 2, 1, 0, 3, 0, 1, 4});
  const Adjacency adjacency = adjacencyOf(mesh);
  EXPECT_EQ(adjacency.nonManifoldEdges, 1u);
  EXPECT_EQ(adjacency.openEdges, 6u);
  EXPECT_EQ(adjacency.sheets, 3u);
  EXPECT_TRUE(std::ranges::all_of(adjacency.links, [](uint32_t link) { return link == kNoLink; }));
}

TEST(Adjacency, TellsNeighboursThatWindTheOtherWayRound) {
  const Mesh mesh = meshOf(kSquare, {0, 1, 2, 3, 2, 0});
  const Adjacency adjacency = adjacencyOf(mesh);
  expectMutual(mesh, adjacency);
  EXPECT_TRUE(linkTurns(adjacency.links[1]));
}

// Two meshes of one surface are linked where each is open; two closed ones that touch along an edge are not disturbed.
TEST(Adjacency, ReachesAcrossMeshesWhereBothAreOpen) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<uint32_t> indices = {0, 1, 2, 3, 4, 5};
  const std::array<uint32_t, 2> firsts = {0, 1};
  const Adjacency adjacency = computeAdjacency(positions, indices, firsts);
  EXPECT_EQ(linkedTriangle(adjacency.links[1]), 1u);
  EXPECT_EQ(adjacency.openEdges, 4u);

  const Scene scene = openScene("contact");
  const auto box = std::ranges::find_if(scene.meshes, &Mesh::closed);
  ASSERT_NE(box, scene.meshes.end());
  std::vector<glm::vec3> twice = box->positions;
  std::vector<uint32_t> both = box->indices;
  twice.insert(twice.end(), box->positions.begin(), box->positions.end());  // in the same place: every edge is of four
  for (const uint32_t index : box->indices) both.push_back(index + static_cast<uint32_t>(box->positions.size()));
  const std::array<uint32_t, 2> starts = {0, static_cast<uint32_t>(box->indices.size() / 3)};
  const Adjacency pair = computeAdjacency(twice, both, starts);
  EXPECT_EQ(pair.openEdges, 0u);
  EXPECT_EQ(pair.nonManifoldEdges, 0u);
  EXPECT_EQ(pair.sheets, 2 * adjacencyOf(*box).sheets);
}

// The order of triangles, and which corner each begins with, changes nothing but names.
TEST(Adjacency, DoesNotDependOnTheOrder) {
  const Scene scene = openScene("atrium");
  const Mesh& mesh = *std::ranges::max_element(scene.meshes, {}, [](const Mesh& m) { return m.indices.size(); });
  const Adjacency given = adjacencyOf(mesh);
  std::vector<uint32_t> order(mesh.indices.size() / 3);
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  Mesh shuffled = mesh;
  for (uint32_t i = 0; i < order.size(); ++i)
    for (uint32_t k = 0; k < 3; ++k) shuffled.indices[3 * i + k] = mesh.indices[3 * order[i] + (k + i) % 3];
  const Adjacency other = adjacencyOf(shuffled);
  expectMutual(shuffled, other);
  EXPECT_EQ(other.openEdges, given.openEdges);
  EXPECT_EQ(other.nonManifoldEdges, given.nonManifoldEdges);
  EXPECT_EQ(other.sheets, given.sheets);
}

}  // namespace
}  // namespace gnomon
