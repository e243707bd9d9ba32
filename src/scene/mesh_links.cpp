#include "scene/mesh_links.h"

#include "scene/adjacency.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon {

namespace {

// Of the meshes as they stand one after another; each seen by itself where `apart`.
Adjacency adjacencyOf(const Scene& scene, bool apart) {
  Adjacency all;
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices, firstTriangles;
  for (const Mesh& mesh : scene.meshes) {
    const auto firstVertex = static_cast<uint32_t>(positions.size());
    const auto firstTriangle = static_cast<uint32_t>(apart ? all.links.size() / 3 : indices.size() / 3);
    if (!apart) {
      firstTriangles.push_back(firstTriangle);
      positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
      for (const uint32_t index : mesh.indices) indices.push_back(firstVertex + index);
      continue;
    }
    const Adjacency own = computeAdjacency(mesh.positions, mesh.indices);
    for (const uint32_t link : own.links)
      all.links.push_back(link == glsl::kNoLink ? link : link + (firstTriangle << 3u));
    for (const uint32_t sheet : own.sheetOf)
      all.sheetOf.push_back(sheet == kNoSheet ? sheet : sheet + static_cast<uint32_t>(all.sheets));
    all.sheets += own.sheets;
  }
  return apart ? all : computeAdjacency(positions, indices, firstTriangles);
}

}  // namespace

MeshLinks linkMeshes(const Scene& scene, bool instanced) {
  std::vector<uint32_t> instanceOf(scene.meshes.size(), std::numeric_limits<uint32_t>::max());
  for (size_t i = scene.instances.size(); i-- > 0;)
    instanceOf[static_cast<size_t>(scene.instances[i].mesh)] = static_cast<uint32_t>(i);
  const bool allStand = std::ranges::find(instanceOf, std::numeric_limits<uint32_t>::max()) == instanceOf.end();
  const Adjacency adjacency = adjacencyOf(scene, instanced || !allStand);
  MeshLinks links;
  links.rows.reserve(adjacency.links.size());
  links.facts.reserve(adjacency.sheetOf.size());
  for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    const Mesh& own = scene.meshes[mesh];
    for (const uint32_t index : own.indices)
      links.rows.push_back({.corner = own.positions[index], .link = adjacency.links[links.rows.size()]});
    for (size_t t = 0; t < own.indices.size() / 3; ++t)
      links.facts.push_back({.instance = instanceOf[mesh], .sheet = adjacency.sheetOf[links.facts.size()]});
  }
  return links;
}

float receiverMargin(const Bounds& bounds) {
  constexpr float kUlps = 8.0f;  // kEndMarginUlps of truth/visibility.h, which derives it
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(bounds.lower[axis]), std::abs(bounds.upper[axis])});
  return kUlps * (std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest);
}

}  // namespace gnomon
