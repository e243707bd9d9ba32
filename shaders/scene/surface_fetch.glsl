// What a pixel sees, from the triangle its G-buffer entry names: the point, its plane, its material and uv.
#ifndef GNOMON_SURFACE_FETCH_GLSL
#define GNOMON_SURFACE_FETCH_GLSL

#include "shared/geometry.glsl"
#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindIndices) readonly buffer Indices { uint indices[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

uvec3 triangleVertices(PrimitiveId id) {
  SceneInstance instance = instances[id.instancePlusOne - 1u];
  uint first = instance.firstIndex + 3u * id.primitive;
  return uvec3(indices[first], indices[first + 1u], indices[first + 2u]) + instance.vertexOffset;
}

// In the world.
SurfacePoint fetchSurface(CameraView camera, ivec2 pixel, PrimitiveId id) {
  uvec3 v = triangleVertices(id);
  mat4 worldFromMesh = instances[id.instancePlusOne - 1u].worldFromMesh;
  vec3 a = vec3(transform(worldFromMesh, vec4(positions[v.x], 1.0f)));
  vec3 b = vec3(transform(worldFromMesh, vec4(positions[v.y], 1.0f)));
  vec3 c = vec3(transform(worldFromMesh, vec4(positions[v.z], 1.0f)));
  Ray ray;
  ray.origin = camera.eyeW;
  ray.dir = unitVector(pixelDirection(camera, pixel.x, pixel.y));
  return surfacePoint(ray, a, b, c);
}

#endif
