// Triangles that may be drawn with straight edges: what cut_for_paraboloid.comp.glsl finds for a slice and the draw
// after it reads, at the same bindings as bounded_triangle.glsl and in the same buffer.
#ifndef GNOMON_STRAIGHT_TRIANGLE_GLSL
#define GNOMON_STRAIGHT_TRIANGLE_GLSL

#include "shared/bounded_triangle.glsl"

GNOMON_SHARED_BEGIN

struct StraightTriangle {
  // x and y on the slice's square, (-1, -1) where u = v = 0; depth; how far within the rim, for gl_ClipDistance
  vec4 a, b, c;
  vec2 uvA, uvB, uvC;
  uint triangle;  // of which it is a piece, in the array of all triangles
  uint instance;
  uint id;  // of both
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::StraightTriangle) == 84);
static_assert(sizeof(gnomon::glsl::StraightTriangle) <= sizeof(gnomon::glsl::BoundedTriangle));
#endif
#endif
