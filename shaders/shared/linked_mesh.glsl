// Triangles that know their neighbours: the table that a walk over a mesh reads (src/scene/adjacency.h fills it).
//
//             corner 2               Row k of a triangle, at 3 * triangle + k, is its corner k and what lies across
//               / \                  the edge opposite to it, from corner k + 1 to corner k + 2 (modulo 3):
//      edge 1  /   \  edge 0
//             /     \                  link = neighbour << 3 | turned << 2 | the neighbour's row opposite to the edge
//     corner 0-------corner 1
//              edge 2                  turned: the neighbour winds the other way round. kNoLink where the edge is
//                                      open or belongs to more than two triangles.
#ifndef GNOMON_LINKED_MESH_GLSL
#define GNOMON_LINKED_MESH_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const uint kNoLink = 0xffffffffu;
const uint kMostLinkedTriangles = 0x1fffffffu;

struct MeshRow {
  vec3 corner;  // in the mesh's space
  uint link;
};

GNOMON_FN uint packLink(uint neighbour, bool turned, int row) {
  return neighbour << 3u | (turned ? 4u : 0u) | uint(row);
}
GNOMON_FN uint linkedTriangle(uint link) { return link >> 3u; }
GNOMON_FN bool linkTurns(uint link) { return (link & 4u) != 0u; }
GNOMON_FN int linkedRow(uint link) { return int(link & 3u); }

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::MeshRow) == 16);
#endif
#endif
