// A vertex to one face of the plain renderer's cube.
#include "shared/plain_forward.glsl"

layout(scalar, binding = kBindPlain) uniform Plain { PlainUniforms plain; };
layout(push_constant, scalar) uniform Push { PlainPush push; };

layout(location = 0) in vec3 positionM;

layout(location = 0) out vec3 posW;

void main() {
  posW = vec3(push.worldFromMesh * vec4(positionM, 1.0f));
  gl_Position = plain.faceFromWorld[push.face] * vec4(posW, 1.0f);
}
