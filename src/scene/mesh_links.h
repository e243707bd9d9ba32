#pragma once
// The scene's triangles with their neighbours, as shared/lookup_tables.glsl reads them: what a walk over a mesh needs.
//
// Neighbours are a mesh's own, so that its instances share them; where every mesh stands in the world, once, they reach
// across the meshes that a file made of one surface's materials.

#include "scene/scene.h"

#include "shared/lookup_tables.glsl"

#include <vector>

namespace gnomon {

struct MeshLinks {
  std::vector<glsl::MeshRow> rows;         // three a triangle, in the order of the array of all triangles
  std::vector<glsl::TriangleFacts> facts;  // one a triangle
};

MeshLinks linkMeshes(const Scene& scene, bool instanced);

// LookupTables::endMargin: how far before a receiver's plane a surface must stand to shadow it, metres.
float receiverMargin(const Bounds& sceneBoundsW);

}  // namespace gnomon
