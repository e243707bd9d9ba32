#version 460
layout(push_constant) uniform Push {
  mat4 clipFromWorld;
  mat4 worldFromMesh;
};
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out flat vec3 normalW;
layout(location = 1) out flat uint instance;
invariant gl_Position;

void main() {
  normalW = mat3(worldFromMesh) * normal;
  instance = gl_InstanceIndex;
  precise vec4 clip = clipFromWorld * (worldFromMesh * vec4(position, 1.0));
  gl_Position = clip;
}
