#pragma once
// Which triangles of a mesh are neighbours: across each edge the one other triangle that shares it, corners at equal
// positions being one (glTF splits vertices where normals or uvs differ). Linear in the number of triangles.
//
// An edge of one triangle is open; of three or more, non-manifold; neither leads anywhere. Triangles without area (two
// corners at one position) have no neighbours. Of faces that stand at the same three positions, however they wind, the
// first is everybody's neighbour, and the others have its neighbours.

#include "scene/scene.h"

#include "shared/linked_mesh.glsl"

#include <span>
#include <vector>

namespace gnomon {

inline constexpr uint32_t kNoSheet = 0xffffffffu;

struct Adjacency {
  std::vector<uint32_t> links;    // three a triangle, as in shared/linked_mesh.glsl
  std::vector<uint32_t> sheetOf;  // of each triangle: the connected surface it is of, or kNoSheet
  size_t openEdges = 0, nonManifoldEdges = 0, sheets = 0;
};

Adjacency computeAdjacency(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

// Meshes that stand in one space, one after another in `indices`, which count through `positions`: each mesh's own
// neighbours, then those of its open edges that exactly one open edge of another mesh meets. (Welded all at once, the
// common edge of two boxes that touch would be of four triangles, and lead nowhere.) Counts are those of the whole.
Adjacency computeAdjacency(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                           std::span<const uint32_t> firstTriangles);

}  // namespace gnomon
