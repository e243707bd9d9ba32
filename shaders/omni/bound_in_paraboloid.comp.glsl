// The triangles that a slice of a paraboloid map shows, one invocation each; large ones have a bound for each of
// several pieces, all with the whole triangle's planes, so that no texel is decided otherwise.
#include "shared/bounded_triangle.glsl"
#include "shared/paraboloid_pieces.glsl"

#include "shadow/light_triangle_fetch.glsl"

layout(local_size_x = kBoundGroupSize) in;

layout(scalar, binding = kBindBoundedTriangles) writeonly buffer Found { BoundedTriangle found[]; };
layout(scalar, binding = kBindBoundedDraw) buffer DrawArguments { BoundedDraw draw; };

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
  LightTriangle triangle = fetchLightTriangle(index, instance);
  if (facing != 0 && float(facing) * triangle.volume >= 0.0f) return;
  Piece whole;
  whole.a = triangle.a;
  whole.b = triangle.b;
  whole.c = triangle.c;
  whole.uvA = whole.uvB = whole.uvC = vec2(0.0f, 0.0f);
  vec3 inverseNormal = inversePlaneNormal(triangle);
  Piece waiting[kMostWaiting];
  int waitingCount = 0;
  Piece piece = whole;
  bool more = true;
  while (more) {
    QuadBound bound = paraboloidBound(shadowMap.width, slice, lightTriangle(piece.a, piece.b, piece.c));
    bool seen = bound.p0 != bound.p1 || bound.p1 != bound.p2;
    // What finds no room stays whole: its bound is wider, and nothing else.
    if (seen && waitingCount < kMostWaiting && isWorthHalving(shadowMap.width, slice, piece, bound) &&
        atomicAdd(draw.extraCount, 1u) < kMostExtraTriangles) {
      PieceHalves halves = halvesOf(shadowMap.width, slice, piece, false);
      waiting[waitingCount] = halves.second;
      ++waitingCount;
      piece = halves.first;
      continue;
    }
    if (seen) {
      BoundedTriangle result;
      result.p0 = vec2(bound.p0.x, -bound.p0.y);
      result.p1 = vec2(bound.p1.x, -bound.p1.y);
      result.p2 = vec2(bound.p2.x, -bound.p2.y);
      result.p3 = vec2(bound.p3.x, -bound.p3.y);
      result.sideA = triangle.sideA;
      result.sideB = triangle.sideB;
      result.sideC = triangle.sideC;
      result.inverseNormal = inverseNormal;
      result.triangle = index;
      result.instance = instance;
      result.id = firstId + (index - firstTriangle);
      // In any order: the nearest depth is the same.
      found[atomicAdd(draw.vertexCount, 6u) / 6u] = result;
    }
    more = waitingCount > 0;
    if (more) piece = waiting[--waitingCount];
  }
}
