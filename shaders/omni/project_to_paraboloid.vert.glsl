// Projects a vertex to a slice of a paraboloid map, as in Brabec et al. 2002: vertices are right, but edges are drawn
// straight although they should be arcs. Kept for comparison with bound_in_paraboloid.comp.glsl.
#include "shared/shade.glsl"

#include "shadow/drawn_slice.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

layout(location = 0) out vec2 uv;
layout(location = 1) out flat uint instanceIndex;
layout(location = 2) out flat uint firstTriangle;
layout(location = 3) out flat uint firstId;

void main() {
  instanceIndex = gl_InstanceIndex;
  firstTriangle = rangeTriangle;
  firstId = rangeId;
  uv = uvs[gl_VertexIndex];
  vec3 posW = vec3(transform(instances[gl_InstanceIndex].worldFromMesh, vec4(positions[gl_VertexIndex], 1.0f)));
  vec3 posL = lightFromWorld(lightFrame, posW);
  float radius = length(posL);
  float w = posL.z * paraboloidAxisZ(slice);
  // The opposite pole lies at infinity; the horizon cuts what comes near it.
  float scale = 1.0f / max(radius + w, 1e-3f * radius);
  gl_Position = vec4(posL.x * scale, -posL.y * scale, paraboloidDepth(shadowMap, posL), 1.0f);
  gl_ClipDistance[0] = w;
}
