// The triangles that a slice of a paraboloid map shows, one invocation each. Those that take long are left to
// bound_large_in_paraboloid.comp.glsl: lavapipe runs both sides of every branch for all.
#include "shared/paraboloid_pieces.glsl"

#include "omni/append_in_paraboloid.glsl"
#include "shadow/light_triangle_fetch.glsl"

layout(local_size_x = kBoundGroupSize) in;

layout(scalar, binding = kBindLargeTriangles) writeonly buffer LargeTriangles { LargeTriangle large[]; };

layout(push_constant, scalar) uniform Push {
  int slice;
  int facing;  // 1: only what winds counter-clockwise seen from the light, -1: only the rest, 0: both
  uint firstTriangle;
  uint triangleCount;
  uint instance;
  uint firstId;  // of firstTriangle
};

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  uint id = firstId + gl_GlobalInvocationID.x;
  LightTriangle triangle = fetchLightTriangle(index, instance);
  if (facing != 0 && float(facing) * triangle.volume >= 0.0f) return;
  BoundBasis basis = boundBasis(shadowMap.width, slice, triangle);
  if (!basis.seen) return;
  QuadBound bound = boundAhead(basis);
  Piece whole;
  whole.a = triangle.a;
  whole.b = triangle.b;
  whole.c = triangle.c;
  if (basis.isAhead && !isWasteful(shadowMap.width, slice, whole, bound)) {
    append(bound, triangle, inversePlaneNormal(triangle), index, instance, id);
  } else {
    uint i = atomicAdd(draw.largeCount, 1u);
    large[i].triangle = index;
    large[i].instance = instance;
    large[i].id = id;
    atomicMax(draw.largeGroups, i / uint(kBoundGroupSize) + 1u);
  }
}
