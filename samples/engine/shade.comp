#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform texture2D depths;
layout(binding = 1) uniform texture2D normals;
layout(binding = 2) uniform utexture2D triangles;
layout(binding = 3, r8) uniform readonly image2D visibility;
layout(binding = 4, rgba16f) uniform readonly image2D fog;
layout(binding = 5, rgba8) uniform writeonly image2D picture;
layout(binding = 6) readonly buffer Colors { vec4 colors[]; };  // one an instance
layout(push_constant) uniform Push {
  mat4 worldFromEye;
  vec4 lightW;    // and its strength
  vec2 tanHalf;
  float zNear;
  float fogLeft;  // what a metre of fog leaves of light, as a logarithm
};
#extension GL_EXT_samplerless_texture_functions : require

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(depths, 0);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
  vec3 ray = vec3(ndc * vec2(1.0, -1.0) * tanHalf, -1.0);
  float depth = texelFetch(depths, pixel, 0).x;
  vec3 light = imageLoad(fog, pixel).rgb;
  if (depth > 0.0) {
    vec3 at = (worldFromEye * vec4(ray * (zNear / depth), 1.0)).xyz;
    vec3 toLight = lightW.xyz - at, n = texelFetch(normals, pixel, 0).xyz;
    float r = length(toLight), path = r + length(at - worldFromEye[3].xyz);
    float lit = max(dot(n, toLight) / r, 0.0) * imageLoad(visibility, pixel).x * exp(-fogLeft * path);
    vec3 color = colors[texelFetch(triangles, pixel, 0).x - 1u].rgb;
    light += color * (0.05 + lightW.w * lit / (3.14159 * r * r));
  }
  imageStore(picture, pixel, vec4(pow(light / (1.0 + light), vec3(1.0 / 2.2)), 1.0));
}
