// The triangles that a slice of a paraboloid map shows, one invocation each, cut until they may be drawn with straight
// edges (paraboloid_pieces.glsl).
//
// mapDepth is called by its case: lavapipe inlines uniforms that loops and branches depend on, and a switch in the loop
// had it compile the shader again for every dispatch (measured: 12 times slower).
#include "shared/paraboloid_pieces.glsl"
#include "shared/straight_triangle.glsl"

#include "shadow/light_triangle_fetch.glsl"

layout(local_size_x = kBoundGroupSize) in;

layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(scalar, binding = kBindBoundedTriangles) writeonly buffer Found { StraightTriangle found[]; };
layout(scalar, binding = kBindBoundedDraw) buffer DrawArguments { BoundedDraw draw; };

layout(push_constant, scalar) uniform Push {
  int slice;
  int facing;  // 1: only what winds counter-clockwise seen from the light, -1: only the rest, 0: both
  uint firstTriangle;
  uint triangleCount;
  uint instance;
  uint firstId;  // of firstTriangle
};

vec4 onSlice(vec3 posL) {
  vec3 p = sliceFromLight(slice, posL);
  float radius = length(p);
  // Near the opposite pole only where there was no room to cut; the rim cuts what comes near it.
  vec2 at = vec2(p.x, p.y) * (1.0f / max(radius + p.z, 1e-3f * radius));
  // A value of the corner alone, so that pieces that share an edge are cut at the same place of it.
  float rim = drawnRim(shadowMap.width);
  return vec4(at.x, -at.y, paraboloidDepth(shadowMap, posL), rim * rim - dot(at, at));
}

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  LightTriangle triangle = fetchLightTriangle(index, instance);
  if (facing != 0 && float(facing) * triangle.volume >= 0.0f) return;
  uvec3 v = triangles[index];
  Piece whole;
  whole.a = triangle.a;
  whole.b = triangle.b;
  whole.c = triangle.c;
  whole.uvA = uvs[v.x];
  whole.uvB = uvs[v.y];
  whole.uvC = uvs[v.z];
  Piece waiting[kMostWaiting];
  int waitingCount = 0;
  Piece piece = whole;
  bool more = true;
  while (more) {
    bool seen = !isBeyondRim(shadowMap.width, slice, piece);
    if (seen && waitingCount < kMostWaiting && !isDrawnStraight(shadowMap.width, slice, piece) &&
        atomicAdd(draw.extraCount, 1u) < kMostExtraTriangles) {
      PieceHalves halves = halvesOf(shadowMap.width, slice, piece, true);
      waiting[waitingCount] = halves.second;
      ++waitingCount;
      piece = halves.first;
      continue;
    }
    if (seen) {
      StraightTriangle result;
      result.a = onSlice(piece.a);
      result.b = onSlice(piece.b);
      result.c = onSlice(piece.c);
      result.uvA = piece.uvA;
      result.uvB = piece.uvB;
      result.uvC = piece.uvC;
      result.triangle = index;
      result.instance = instance;
      result.id = firstId + (index - firstTriangle);
      // In any order: the nearest depth is the same.
      found[atomicAdd(draw.vertexCount, 3u) / 3u] = result;
    }
    more = waitingCount > 0;
    if (more) piece = waiting[--waitingCount];
  }
}
