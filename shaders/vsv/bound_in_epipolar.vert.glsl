// Corner gl_VertexIndex % 6 of the two triangles that enclose what triangle gl_VertexIndex / 6 covers of a shadow volume's columns.
#include "shared/epipolar_bound.glsl"

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
  LightTriangle triangle = fetchLightTriangle(triangleIndex, gl_InstanceIndex);
  vec2 at = vec2(-1.0f);
  if (float(facing) * triangle.volume < 0.0f || facing == 0) {
    EpipolarGrid grid = shadowMap.epipolar;
    at = epipolarBoundCorner(grid, epipolarBox(grid, triangle), gl_VertexIndex % 6);
  }
  gl_Position = vec4(at / mapTexelCounts(shadowMap) * 2.0f - 1.0f, 0.5f, 1.0f);
  sideA = triangle.sideA;
  sideB = triangle.sideB;
  sideC = triangle.sideC;
  cornerA = triangle.a;
  cornerB = triangle.b;
  cornerC = triangle.c;
  triangleAndInstance = uvec2(triangleIndex, uint(gl_InstanceIndex));
}
