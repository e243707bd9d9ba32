// A vertex to the plain renderer's camera.
#include "shared/plain_forward.glsl"

layout(scalar, binding = kBindPlain) uniform Plain { PlainUniforms plain; };
layout(push_constant, scalar) uniform Push { PlainPush push; };

layout(location = 0) in vec3 positionM;
layout(location = 1) in vec3 normalM;
layout(location = 2) in vec2 uvM;

layout(location = 0) out vec3 posW;
layout(location = 1) out vec3 normalW;
layout(location = 2) out vec2 uv;

void main() {
  vec4 position = push.worldFromMesh * vec4(positionM, 1.0f);
  posW = vec3(position);
  normalW = mat3(push.worldFromMesh) * normalM;
  uv = uvM;
  gl_Position = plain.clipFromWorld * position;
}
