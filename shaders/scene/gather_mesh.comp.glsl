// Copies a mesh from a renderer's vertex and index buffers, whatever their layout, into the scene's tables
// (src/scene/lent_geometry.h): positions, triangles, and where the biases need them, the corners of the rows that walk
// the mesh. One invocation copies one vertex or one triangle.
#include "shared/gather_mesh.glsl"
#include "shared/linked_mesh.glsl"
#include "shared/scene.glsl"

layout(local_size_x = kGatherGroupSize) in;

layout(push_constant, scalar) uniform Push { GatherPush push; };

layout(scalar, binding = kBindLentVertices) readonly buffer LentVertices { uint vertexWords[]; };
layout(scalar, binding = kBindLentIndices) readonly buffer LentIndices { uint indexWords[]; };
layout(scalar, binding = kBindPositions) writeonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindTriangles) writeonly buffer Triangles { uint corners[]; };
layout(scalar, binding = kBindGatheredRows) buffer Rows { MeshRow rows[]; };

vec3 lentPosition(uint vertex) {
  uint at = push.vertexWord + vertex * push.strideWords;
  if (push.format == kGatherFloat)
    return vec3(uintBitsToFloat(vertexWords[at]), uintBitsToFloat(vertexWords[at + 1u]),
                uintBitsToFloat(vertexWords[at + 2u]));
  if (push.format == kGatherHalf)
    return vec3(unpackHalf2x16(vertexWords[at]), unpackHalf2x16(vertexWords[at + 1u]).x);
  return vec3(unpackSnorm2x16(vertexWords[at]), unpackSnorm2x16(vertexWords[at + 1u]).x);
}

uint lentIndex(uint place) {
  if (push.shortIndices == 0) return indexWords[(push.indexByte >> 2u) + place];
  uint half_ = (push.indexByte >> 1u) + place;
  return indexWords[half_ >> 1u] >> (16u * (half_ & 1u)) & 0xffffu;
}

void main() {
  uint i = gl_GlobalInvocationID.y * (kGatherGroupSize * kMostGatherGroupsX) + gl_GlobalInvocationID.x;
  if (i < push.vertexCount) positions[push.firstVertex + i] = lentPosition(i);
  if (i >= push.triangleCount) return;
  uint at = 3u * (push.firstTriangle + i);
  for (uint k = 0u; k < 3u; ++k) {
    uint vertex = lentIndex(3u * i + k);
    corners[at + k] = push.firstVertex + vertex;
    if (push.hasRows == 1) rows[at + k].corner = lentPosition(vertex);
  }
}
