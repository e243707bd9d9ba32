// The non-linear rasterizer's triangles: what a compute shader finds for a slice and the draw after it reads
// (src/shadow/bounded_draws.h).
#ifndef GNOMON_BOUNDED_TRIANGLE_GLSL
#define GNOMON_BOUNDED_TRIANGLE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindBoundedTriangles = 17;  // BoundedTriangle[]
const int kBindBoundedDraw = 18;       // BoundedDraw
const int kBoundGroupSize = 64;

// How many there are.
struct BoundedDraw {
  uint vertexCount;  // the front is a VkDrawIndirectCommand
  uint instanceCount, firstVertex, firstInstance;
  uint extraCount;  // triangles beyond one for each of the batch, which were cut in pieces
};
const uint kMostExtraTriangles = 1u << 18u;  // room for them in a batch

// Four corners that enclose a triangle's projection, on the slice's square: (-1, -1) is where u = v = 0.
struct BoundedTriangle {
  vec2 p0, p1, p2, p3;       // in order around it
  vec3 sideA, sideB, sideC;  // ray_triangle.glsl
  vec3 inverseNormal;
  uint triangle;  // in the array of all triangles
  uint instance;
  uint id;  // of both (shared/triangle_ids.glsl)
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::BoundedTriangle) == 92);
static_assert(offsetof(gnomon::glsl::BoundedTriangle, id) == 88);
static_assert(sizeof(gnomon::glsl::BoundedDraw) == 20);
#endif
#endif
