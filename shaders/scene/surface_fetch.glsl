// Fetches a pixel's surface from its G-buffer triangle: the point, its plane, its material and uv.
#ifndef GNOMON_SURFACE_FETCH_GLSL
#define GNOMON_SURFACE_FETCH_GLSL

#include "shared/geometry.glsl"
#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = kBindPrimitiveIds) uniform utexture2D primitiveIds;
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

// 0: every mesh stands in world space, and no matrix need be read. On lavapipe a gather from a storage buffer runs lane
// by lane (measured: reading the matrix too makes the visibility pass 1.2 to 1.3 times slower), so a pixel makes four:
// a triangle and three corners.
layout(constant_id = 4) const int kInstanced = 1;

// 1: the picture names triangles within their mesh, as a renderer's own gl_PrimitiveID does, and not in the array of
// all (src/scene/receiver_picture.h).
layout(constant_id = 12) const int kTrianglesOfMesh = 0;

PrimitiveId fetchPrimitive(ivec2 pixel) {
  uvec2 named = texelFetch(primitiveIds, pixel, 0).xy;
  PrimitiveId id;
  id.instancePlusOne = named.x;
  id.triangle = named.y;
  if (kTrianglesOfMesh == 1 && named.x != 0u) id.triangle += instances[named.x - 1u].firstTriangle;
  return id;
}

// In the world.
SurfacePoint fetchSurface(CameraView camera, ivec2 pixel, PrimitiveId id) {
  uvec3 v = triangles[id.triangle];
  vec3 a = positions[v.x];
  vec3 b = positions[v.y];
  vec3 c = positions[v.z];
  if (kInstanced == 1) {
    mat4 worldFromMesh = instances[id.instancePlusOne - 1u].worldFromMesh;
    a = vec3(transform(worldFromMesh, vec4(a, 1.0f)));
    b = vec3(transform(worldFromMesh, vec4(b, 1.0f)));
    c = vec3(transform(worldFromMesh, vec4(c, 1.0f)));
  }
  Ray ray;
  ray.origin = camera.eyeW;
  ray.dir = unitVector(pixelDirection(camera, pixel.x, pixel.y));
  return surfacePoint(ray, a, b, c);
}

#endif
