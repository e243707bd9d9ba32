// Where a compute shader writes the triangles that it bounds, for pull_bounded_triangle.vert.glsl.
#ifndef GNOMON_APPEND_BOUNDED_GLSL
#define GNOMON_APPEND_BOUNDED_GLSL

#include "shared/bounded_triangle.glsl"

layout(scalar, binding = kBindBoundedTriangles) writeonly buffer Found { BoundedTriangle found[]; };
layout(scalar, binding = kBindBoundedDraw) buffer DrawArguments {
  BoundedDraw draw;
  uint drawn[];
};

// In any order: the nearest depth is the same.
void append(BoundedTriangle triangle) {
  uint i = atomicAdd(draw.triangleCount, 1u);
  found[i] = triangle;
  bool four = triangle.corners[2] != triangle.corners[3];
  uint at = atomicAdd(draw.vertexCount, four ? 6u : 3u) / 3u;
  drawn[at] = 2u * i;
  if (four) drawn[at + 1u] = 2u * i + 1u;
}

#endif
