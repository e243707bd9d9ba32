// A textured, diffuse surface under a point light, with one tap of a cube of distances and a constant bias.
#include "shared/plain_forward.glsl"

layout(scalar, binding = kBindPlain) uniform Plain { PlainUniforms plain; };
layout(push_constant, scalar) uniform Push { PlainPush push; };
layout(binding = kBindPlainDistances) uniform samplerCube distances;
layout(binding = kBindPlainColor) uniform sampler2D color;

layout(location = 0) in vec3 posW;
layout(location = 1) in vec3 normalW;
layout(location = 2) in vec2 uv;

layout(location = 0) out vec4 radiance;

void main() {
  vec3 fromLight = posW - plain.lightW;
  float distance_ = length(fromLight);
  float stored = texture(distances, fromLight).x * plain.zFar;
  float lit = distance_ <= stored + plain.offset ? 1.0f : 0.0f;
  vec3 normal = normalize(normalW);
  if (normalW == vec3(0.0f)) normal = normalize(cross(dFdx(posW), dFdy(posW)));  // a mesh without normals
  float diffuse = max(dot(normal, -fromLight / distance_), 0.0f) / (distance_ * distance_);
  vec3 albedo = push.baseColor.xyz * texture(color, uv).xyz;
  radiance = vec4(albedo * (plain.lightColor * (diffuse * lit) + plain.ambient), 1.0f);
}
