#pragma once
// How the triangles of a scene's instances are numbered, as the texels of a map name them: shared/triangle_ids.glsl has
// the scheme, this chooses its numbers.

#include "scene/scene.h"

#include "shared/scene.glsl"
#include "shared/triangle_ids.glsl"

#include <cstdint>
#include <vector>

namespace gnomon {

struct TriangleIds {
  std::vector<uint32_t> firstIds;     // of each instance's first triangle
  std::vector<glsl::IdChunk> chunks;  // empty where no mesh is instanced
  uint32_t shift = 0;                 // triangles of a chunk: 2^shift
};

// Of instances with so many triangles, each mesh's beginning at firstTriangles[instance] in the array of all. Throws
// WorldError where there are more than 32 bits can name.
TriangleIds numberTriangles(const std::vector<uint32_t>& triangleCounts, const std::vector<uint32_t>& firstTriangles,
                            bool instanced);

// Which triangle of which instance an id names, counted within the mesh, as downloadPrimitiveIds() gives them: the
// first word is 0 for kNoId.
glsl::PrimitiveId primitiveOf(const TriangleIds& ids, const std::vector<uint32_t>& firstTriangles, uint32_t id);

}  // namespace gnomon
