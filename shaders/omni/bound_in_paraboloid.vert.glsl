// Corner gl_VertexIndex % 6 of the two triangles that enclose what triangle gl_VertexIndex / 6 covers of a layer of a paraboloid map.
#include "shared/paraboloid_bound.glsl"

#include "shadow/light_triangle_fetch.glsl"
#define GNOMON_BOUNDED_OUT
#include "shadow/bounded_triangle.glsl"

layout(push_constant, scalar) uniform Push {
  int layer;
  float tolerance;
  int facing;  // 1: only what winds counter-clockwise seen from the light, -1: only the rest, 0: both
};

void main() {
  uint triangleIndex = uint(gl_VertexIndex) / 6u;
  uint corner = uint(gl_VertexIndex) % 6u;
  LightTriangle triangle = fetchLightTriangle(triangleIndex, gl_InstanceIndex);
  QuadBound bound = emptyBound();
  if (float(facing) * triangle.volume < 0.0f || facing == 0) bound = paraboloidBound(shadowMap.side, layer, triangle);
  vec2 at = bound.p0;
  if (corner == 1u) at = bound.p1;
  if (corner == 2u || corner == 3u) at = bound.p2;
  if (corner == 4u) at = bound.p3;
  gl_Position = vec4(at.x, -at.y, 0.5f, 1.0f);
  sideA = triangle.sideA;
  sideB = triangle.sideB;
  sideC = triangle.sideC;
  cornerA = triangle.a;
  cornerB = triangle.b;
  cornerC = triangle.c;
  triangleAndInstance = uvec2(triangleIndex, uint(gl_InstanceIndex));
}
