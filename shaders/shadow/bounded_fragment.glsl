// What a fragment of a bounded triangle begins with.
#ifndef GNOMON_BOUNDED_FRAGMENT_GLSL
#define GNOMON_BOUNDED_FRAGMENT_GLSL

#include "shared/ray_triangle.glsl"

#include "shadow/bounded_varyings.glsl"
#include "shadow/drawn_fragment.glsl"

LightTriangle boundedTriangle() {
  LightTriangle triangle;
  triangle.sideA = sideAAndNumber.xyz;
  triangle.sideB = sideBAndNumber.xyz;
  triangle.sideC = sideCAndNumber.xyz;
  return triangle;
}

// What the map's mapDrawnNumbers says.
vec4 drawnNumbers() { return vec4(sideAAndNumber.w, sideBAndNumber.w, sideCAndNumber.w, planeAndNumber.w); }

// Metres along a direction of this size to the triangle's plane.
float distanceAlong(vec3 dir, float size) { return size / dot(planeAndNumber.xyz, dir); }

DrawnFragment boundedFragment(float depth) {
  DrawnFragment drawn;
  // What is nearer than the near end lies on it, as depth clamping has it.
  drawn.depth = max(depth, 0.0f);
  drawn.triangle = numbers.x;
  drawn.instance = numbers.y;
  drawn.id = numbers.z;
  return drawn;
}

// Of a plane through the light itself, coordinates' rounding (2^-24 of the scene) says where it is met.
bool isAhead(float along) { return along > uintBitsToFloat(numbers.w) * 2.4e-7f; }

#endif
