// A vertex to the camera's clip space; reversed depth, no far plane (src/scene/gbuffer.cpp).
#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

layout(push_constant, scalar) uniform Push { mat4 clipFromWorld; };

layout(location = 0) out vec2 uv;
layout(location = 1) out flat uint instanceIndex;
layout(location = 2) out flat uint firstTriangle;

void main() {
  instanceIndex = gl_InstanceIndex;
  firstTriangle = instances[gl_InstanceIndex].firstTriangle;
  uv = uvs[gl_VertexIndex];
  // Precise, as in shadow/pull_frame_triangle.vert.glsl, which draws again where the depth is equal.
  precise vec4 position =
      clipFromWorld * (instances[gl_InstanceIndex].worldFromMesh * vec4(positions[gl_VertexIndex], 1.0f));
  gl_Position = position;
}
