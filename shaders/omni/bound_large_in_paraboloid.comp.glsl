// The triangles that bound_in_paraboloid.comp.glsl left over: those that reach behind the light, and large ones, which
// have a bound for each of several pieces, all with the whole triangle's planes, so that no texel is decided otherwise.
#include "shared/paraboloid_pieces.glsl"

#include "omni/append_in_paraboloid.glsl"
#include "shadow/light_triangle_fetch.glsl"

layout(local_size_x = kBoundGroupSize) in;

layout(scalar, binding = kBindLargeTriangles) readonly buffer LargeTriangles { LargeTriangle large[]; };

layout(push_constant, scalar) uniform Push { int slice; };

void main() {
  if (gl_GlobalInvocationID.x >= draw.largeCount) return;
  LargeTriangle which = large[gl_GlobalInvocationID.x];
  LightTriangle triangle = fetchLightTriangle(which.triangle, which.instance);
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
    if (seen) append(bound, triangle, inverseNormal, which.triangle, which.instance, which.id);
    more = waitingCount > 0;
    if (more) piece = waiting[--waitingCount];
  }
}
