// Numbers of triangles: what the channels `ids` and `second-ids` of a map hold. 32 bits name a triangle of an instance;
// 0 is none.
//
//   no mesh is instanced   id = 1 + the triangle's place in the array of all triangles
//   else                   id = 1 + chunk << idShift | place in the chunk: an instance's triangles are cut in chunks
//                          of 2^idShift, and a table says of which instance a chunk is and where it begins. So the ids
//                          of an instance's triangles follow one another, and one look-up takes an id apart.
//
// src/scene/triangle_ids.h chooses the shift so that the ids fit.
#ifndef GNOMON_TRIANGLE_IDS_GLSL
#define GNOMON_TRIANGLE_IDS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const uint kNoId = 0u;

struct IdChunk {
  uint instance;
  uint firstTriangle;  // in the array of all triangles
};

// A triangle in its place.
struct PlacedTriangle {
  uint triangle;  // in the array of all triangles
  uint instance;  // not known where no mesh is instanced: 0
};

GNOMON_FN uint idChunk(uint id, uint shift) { return (id - 1u) >> shift; }

GNOMON_FN PlacedTriangle placedInChunk(IdChunk chunk, uint id, uint shift) {
  PlacedTriangle placed;
  placed.triangle = chunk.firstTriangle + ((id - 1u) & ((1u << shift) - 1u));
  placed.instance = chunk.instance;
  return placed;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::IdChunk) == 8);
#endif
#endif
