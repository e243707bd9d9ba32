// What biases share that move the receiver before it is looked up.
#ifndef GNOMON_BIAS_MOVED_LOOKUP_GLSL
#define GNOMON_BIAS_MOVED_LOOKUP_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Metres between the rays of two neighbouring texels, where the first one passes posL.
GNOMON_FN float texelWidthAt(ShadowMap map, MapPoint point, Ray ray, vec3 posL) {
  Ray next = mapTexelRay(map, point.slice, vec2(point.uv.x + 1.0f / float(map.width), point.uv.y));
  float along = dot(posL - ray.origin, ray.dir);
  vec3 across = (next.origin + next.dir * along) - (ray.origin + ray.dir * along);
  return length(across);
}

// The receiver at another place; one that would come to lie outside the map stays where it is.
GNOMON_FN Receiver movedWithin(ShadowMap map, Receiver receiver, vec3 posL) {
  if (!mapProject(map, posL).covered) return receiver;
  Receiver moved = receiver;
  moved.posL = posL;
  return moved;
}

// Whether depth is measured around a point, rather than along an axis for all texels of a slice.
GNOMON_FN bool looksAround(ShadowMap map) { return mapKind(map) != kMapPlanar; }

GNOMON_SHARED_END
#endif
