// Whether the hole of an alpha mask is where a ray meets the triangle that is drawn; `distances`: sideDistances of it.
#ifndef GNOMON_BOUNDED_HOLE_GLSL
#define GNOMON_BOUNDED_HOLE_GLSL

#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/bounded_varyings.glsl"

layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

bool isHoleAt(vec3 distances) {
  vec3 weight = distances * (1.0f / (distances.x + distances.y + distances.z));
  uvec3 v = triangles[numbers.x];
  vec2 uv = uvs[v.x] * weight.x + uvs[v.y] * weight.y + uvs[v.z] * weight.z;
  return isHole(materials[instances[numbers.y].material], uv);
}

#endif
