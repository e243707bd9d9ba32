// A triangle of the scene in the light's frame, by its number in the array of all triangles.
#ifndef GNOMON_LIGHT_TRIANGLE_FETCH_GLSL
#define GNOMON_LIGHT_TRIANGLE_FETCH_GLSL

#include "shared/map.glsl"
#include "shared/ray_triangle.glsl"
#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

// By the very steps with which the receiver is brought there.
vec3 fetchCornerL(uint vertex, uint instance) {
  vec3 posW = vec3(transform(instances[instance].worldFromMesh, vec4(positions[vertex], 1.0f)));
  return lightFromWorld(lightFrame, posW);
}

LightTriangle fetchLightTriangle(uint triangle, uint instance) {
  uvec3 v = triangles[triangle];
  return lightTriangle(fetchCornerL(v.x, instance), fetchCornerL(v.y, instance), fetchCornerL(v.z, instance));
}

#endif
