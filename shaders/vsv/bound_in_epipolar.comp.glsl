// The triangles that a shadow volume's columns show, one invocation each: a box around each in (theta, phi), and for
// one over the seam of theta another, a turn lower.
#include "shared/epipolar_bound.glsl"

#include "shadow/append_bounded.glsl"
#include "shadow/light_triangle_fetch.glsl"

layout(local_size_x = kBoundGroupSize) in;

layout(push_constant, scalar) uniform Push {
  int slice;
  int facing;  // 1: only what winds counter-clockwise seen from the light, -1: only the rest, 0: both
  uint firstTriangle;
  uint triangleCount;
  uint instance;
  uint firstId;  // of firstTriangle
};

// From columns to the slice's square.
vec2 onSlice(float theta, float phi) { return vec2(theta, phi) / mapTexelCounts(shadowMap) * 2.0f - 1.0f; }

void appendBox(LightTriangle triangle, uint index, vec2 low, vec2 high) {
  BoundedTriangle result;
  result.corners[0] = onSlice(low.x, low.y);
  result.corners[1] = onSlice(high.x, low.y);
  result.corners[2] = onSlice(high.x, high.y);
  result.corners[3] = onSlice(low.x, high.y);
  result.sideA = triangle.sideA;
  result.sideB = triangle.sideB;
  result.sideC = triangle.sideC;
  result.inverseNormal = inversePlaneNormal(triangle);
  result.triangle = index;
  result.instance = instance;
  result.id = firstId + (index - firstTriangle);
  append(result);
}

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  LightTriangle triangle = fetchLightTriangle(index, instance);
  if (facing != 0 && float(facing) * triangle.volume >= 0.0f) return;
  EpipolarGrid grid = shadowMap.epipolar;
  EpipolarBox box = epipolarBox(grid, triangle);
  vec2 counts = mapTexelCounts(shadowMap);
  if (box.high.y < 0.0f || box.low.y > counts.y) return;
  vec2 low = box.low;
  vec2 high = box.high;
  if (epipolarBoxOverSeam(grid, box)) {
    float turn = 2.0f * kPi / grid.thetaStep;
    // Without room for a second box the first one goes all round.
    if (atomicAdd(draw.extraCount, 1u) < kMostExtraTriangles) {
      appendBox(triangle, index, vec2(low.x - turn, low.y), vec2(high.x - turn, high.y));
    } else {
      low.x = 0.0f;
      high.x = counts.x;
    }
  }
  if (low.x <= counts.x) appendBox(triangle, index, low, high);
}
