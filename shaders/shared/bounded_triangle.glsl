// The non-linear rasterizer's triangles: what a compute shader finds for a layer and the draw after it reads
// (src/shadow/bounded_draws.h).
#ifndef GNOMON_BOUNDED_TRIANGLE_GLSL
#define GNOMON_BOUNDED_TRIANGLE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindBoundedTriangles = 17;  // BoundedTriangle[]
const int kBindBoundedDraw = 18;       // a VkDrawIndirectCommand: uint vertexCount, and three more
const int kBoundGroupSize = 64;

// Four corners that enclose a triangle's projection, on the layer's square: (-1, -1) is where u = v = 0.
struct BoundedTriangle {
  vec2 p0, p1, p2, p3;       // in order around it
  vec3 sideA, sideB, sideC;  // ray_triangle.glsl
  vec3 inverseNormal;
  uint triangle;  // in the array of all triangles
  uint instance;
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::BoundedTriangle) == 88);
static_assert(offsetof(gnomon::glsl::BoundedTriangle, instance) == 84);
#endif
#endif
