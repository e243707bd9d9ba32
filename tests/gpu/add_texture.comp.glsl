// One of each kind of binding: output[i] = input[i] * factor + texel i of a texture, of a sampler and of an image.
#include "shared/lang.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 3) const int kScale = 1;
layout(scalar, binding = 0) readonly buffer Input { float values[]; } source;
layout(scalar, binding = 1) writeonly buffer Output { float results[]; };
layout(binding = 2) uniform texture2DArray plain;
layout(binding = 4) uniform sampler2DArray sampled;
layout(binding = 7, r32f) readonly uniform image2DArray stored;
layout(scalar, push_constant) uniform Push {
  uint count;
  vec3 factor;  // scalar layout: at byte 4
};
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  ivec3 p = ivec3(int(i) % 8, (int(i) / 8) % 8, int(i) / 64);
  results[i] = source.values[i] * factor.z + float(kScale) * texelFetch(plain, p, 0).x +
               texelFetch(sampled, p, 0).x + imageLoad(stored, p).x;
}
