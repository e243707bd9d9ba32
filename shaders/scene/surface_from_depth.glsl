// Takes the place of scene/surface_fetch.glsl where a renderer has a depth buffer and no picture of triangles
// (src/scene/receiver_picture.h): the point is where the pixel's ray reaches that depth, and its plane is that of the
// renderer's normals, or where it has none, of the points of the neighbouring pixels that are nearest in depth.
//
// A depth buffer of floats, reversed, is good to an ulp or so of the distance (Reed, "Depth Precision Visualized",
// 2015); 24 bits that are not reversed, to distance^2 / (near 2^24).
#ifndef GNOMON_SURFACE_FETCH_GLSL
#define GNOMON_SURFACE_FETCH_GLSL

#include "shared/geometry.glsl"
#include "shared/receiver_picture.glsl"
#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(binding = kBindReceiverDepth) uniform texture2D receiverDepths;
layout(binding = kBindReceiverNormals) uniform texture2D receiverNormals;
layout(scalar, binding = kBindReceiverPicture) uniform Picture { ReceiverPicture receivers; };

layout(constant_id = 4) const int kInstanced = 1;
layout(constant_id = 12) const int kTrianglesOfMesh = 0;

PrimitiveId fetchPrimitive(ivec2 pixel) {
  PrimitiveId id;
  id.instancePlusOne = texelFetch(receiverDepths, pixel, 0).x == receivers.emptyDepth ? 0u : 1u;
  id.triangle = 0u;
  return id;
}

// Metres along the camera's axis; beyond the picture that of its border.
float axialDistance(CameraView camera, ivec2 pixel) {
  ivec2 held = clamp(pixel, ivec2(0), ivec2(camera.width - 1, camera.height - 1));
  return distanceOfDepth(receivers, texelFetch(receiverDepths, held, 0).x);
}

vec3 pointAt(CameraView camera, ivec2 pixel, float distance) {
  return camera.eyeW + pixelDirection(camera, pixel.x, pixel.y) * distance;
}

// From the pixel to its neighbour to one side or the other, whichever is nearer in depth, as if to the first.
vec3 stepAlong(CameraView camera, ivec2 pixel, ivec2 step, vec3 here, float distance) {
  float after = axialDistance(camera, pixel + step);
  float before = axialDistance(camera, pixel - step);
  if (abs(after - distance) <= abs(before - distance)) return pointAt(camera, pixel + step, after) - here;
  return here - pointAt(camera, pixel - step, before);
}

SurfacePoint fetchSurface(CameraView camera, ivec2 pixel, PrimitiveId id) {
  SurfacePoint surface;
  float distance = axialDistance(camera, pixel);
  surface.position = pointAt(camera, pixel, distance);
  surface.barycentric = vec3(0.0f);
  vec3 normal;
  if (receivers.normals == kReceiverNormalsNone)
    normal = cross(stepAlong(camera, pixel, ivec2(0, -1), surface.position, distance),
                   stepAlong(camera, pixel, ivec2(-1, 0), surface.position, distance));
  else
    normal = decodedNormal(receivers, texelFetch(receiverNormals, pixel, 0));
  float size = length(normal);
  surface.normal = size > 0.0f ? normal * (1.0f / size) : vec3(0.0f);
  return surface;
}

#endif
