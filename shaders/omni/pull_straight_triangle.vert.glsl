// Fetches one vertex of a triangle written by cut_for_paraboloid.comp.glsl.
#include "shared/straight_triangle.glsl"

layout(scalar, binding = kBindBoundedTriangles) readonly buffer Found { StraightTriangle found[]; };

layout(location = 0) out vec2 uv;
layout(location = 1) out flat uint instanceIndex;
layout(location = 2) out flat uint firstTriangle;
layout(location = 3) out flat uint firstId;

void main() {
  uint i = uint(gl_VertexIndex) / 3u;
  uint corner = uint(gl_VertexIndex) % 3u;
  vec4 at = found[i].a;
  uv = found[i].uvA;
  if (corner == 1u) {
    at = found[i].b;
    uv = found[i].uvB;
  }
  if (corner == 2u) {
    at = found[i].c;
    uv = found[i].uvC;
  }
  instanceIndex = found[i].instance;
  firstTriangle = found[i].triangle - i;  // the draw's gl_PrimitiveID is i
  firstId = found[i].id - i;
  gl_Position = vec4(at.x, at.y, at.z, 1.0f);
  gl_ClipDistance[0] = at.w;
}
