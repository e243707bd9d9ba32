// Draws a quad around the projection of each triangle that a bounding compute shader wrote.
#include "shared/bounded_triangle.glsl"

#define GNOMON_BOUNDED_OUT
#include "shadow/bounded_varyings.glsl"

layout(scalar, binding = kBindBoundedTriangles) readonly buffer Found { BoundedTriangle found[]; };

void main() {
  uint i = uint(gl_VertexIndex) / 6u;
  uint corner = uint(gl_VertexIndex) % 6u;
  vec2 at = found[i].p0;
  if (corner == 1u) at = found[i].p1;
  if (corner == 2u || corner == 3u) at = found[i].p2;
  if (corner == 4u) at = found[i].p3;
  gl_Position = vec4(at, 0.5f, 1.0f);
  // Flat: the first corner of each triangle speaks for it.
  if (corner == 0u || corner == 3u) {
    sideA = found[i].sideA;
    sideB = found[i].sideB;
    sideC = found[i].sideC;
    inverseNormal = found[i].inverseNormal;
    triangleAndInstance = uvec2(found[i].triangle, found[i].instance);
    triangleId = found[i].id;
  }
}
