// A pixel's view ray and where it ends: at the surface, or at the medium's reach. The including shader declares `push`.
#ifndef GNOMON_VIEW_RAY_GLSL
#define GNOMON_VIEW_RAY_GLSL

#include "shared/media_pass.glsl"

#include "scene/surface_fetch.glsl"
#include "vsv/store_scattered.glsl"

layout(scalar, binding = kBindMedia) uniform Media { MediaUniforms media; };

struct ViewRay {
  vec3 dirW;  // unit
  float end;  // metres from the eye
};

ViewRay fetchViewRay(ivec2 pixel) {
  ViewRay ray;
  ray.dirW = unitVector(pixelDirection(media.camera, pixel.x, pixel.y));
  ray.end = media.medium.reach;
  PrimitiveId id = fetchPrimitive(pixel);
  if (id.instancePlusOne != 0u)
    ray.end = min(ray.end, dot(fetchSurface(media.camera, pixel, id).position - media.camera.eyeW, ray.dirW));
  return ray;
}

void scatter(ivec2 pixel, vec3 light) {
  vec3 before = vec3(0.0f);
  if (push.add == 1) before = scatteredBefore(pixel, media.camera.width);
  storeScattered(pixel, media.camera.width, before + light);
}

#endif
