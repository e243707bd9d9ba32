// The non-linear rasterizer's triangles: what a compute shader finds for a slice and the draw after it reads
// (src/shadow/bounded_draws.h).
#ifndef GNOMON_BOUNDED_TRIANGLE_GLSL
#define GNOMON_BOUNDED_TRIANGLE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindBoundedTriangles = 17;  // BoundedTriangle[]
const int kBindBoundedDraw = 18;       // BoundedDraw
const int kBindLargeTriangles = 19;    // LargeTriangle[]
const int kBoundGroupSize = 64;

// How many there are. In its buffer follows the list of what is drawn, three vertices each: 2 i + h is half h of
// triangle i's four corners, the first, second and third or the third, fourth and first. Most bounds have three.
struct BoundedDraw {
  uint vertexCount;  // the front is a VkDrawIndirectCommand
  uint instanceCount, firstVertex, firstInstance;
  uint extraCount;     // triangles beyond one for each of the batch, which were cut in pieces
  uint triangleCount;  // BoundedTriangles
  uint largeCount;     // LargeTriangles
  uint largeGroups, one, oneMore;  // a VkDispatchIndirectCommand, a group for each kBoundGroupSize of them
};
// One that a second compute shader bounds.
struct LargeTriangle {
  uint triangle, instance, id;  // as in BoundedTriangle
};
const uint kMostExtraTriangles = 1u << 18u;  // room for them in a batch

// Four corners that enclose a triangle's projection, on the slice's square: (-1, -1) is where u = v = 0.
struct BoundedTriangle {
  vec2 corners[4];           // in order around it; three where the last two are equal
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
static_assert(sizeof(gnomon::glsl::BoundedDraw) == 40);
static_assert(offsetof(gnomon::glsl::BoundedDraw, largeGroups) == 28);
#endif
#endif
