// The distance from the light, as a share of the far end.
#include "shared/plain_forward.glsl"

layout(scalar, binding = kBindPlain) uniform Plain { PlainUniforms plain; };

layout(location = 0) in vec3 posW;

void main() { gl_FragDepth = length(posW - plain.lightW) / plain.zFar; }
