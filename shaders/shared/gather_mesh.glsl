// What scene/gather_mesh.comp.glsl is told of a renderer's vertex and index buffers.
#ifndef GNOMON_GATHER_MESH_GLSL
#define GNOMON_GATHER_MESH_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindLentVertices = 9;
const int kBindLentIndices = 10;
const int kBindGatheredRows = 11;  // MeshRow[], as a storage buffer

const int kGatherGroupSize = 64;
const uint kMostGatherGroupsX = 16384u;

// Formats of positions: 32-bit floats; 16-bit floats; 16-bit signed, normalized.
const int kGatherFloat = 0;
const int kGatherHalf = 1;
const int kGatherSnorm = 2;

struct GatherPush {
  uint vertexWord;   // where the first position is, in words of 4 bytes
  uint strideWords;
  int format;        // kGather*
  uint vertexCount;
  uint firstVertex;  // in the tables
  uint indexByte;    // where the first index is
  int shortIndices;  // 1: of 16 bits
  uint triangleCount;
  uint firstTriangle;  // in the tables
  int hasRows;
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::GatherPush) == 40);
#endif
#endif
