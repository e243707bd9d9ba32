#version 460
layout(location = 0) in flat vec3 normalW;
layout(location = 1) in flat uint instance;
layout(location = 0) out vec4 outNormal;
layout(location = 1) out uvec2 outTriangle;

void main() {
  outNormal = vec4(normalize(normalW), 0.0);
  outTriangle = uvec2(instance + 1u, gl_PrimitiveID);
}
