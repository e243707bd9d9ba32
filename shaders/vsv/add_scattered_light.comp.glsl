// The final picture: surface radiance attenuated by the medium, plus in-scattered light.
#include "shared/media_pass.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(scalar, binding = kBindMedia) uniform Media { MediaUniforms media; };
layout(scalar, binding = kBindInScattered) readonly buffer InScattered { vec3 inScattered[]; };
layout(scalar, binding = kBindSurface) readonly buffer Surface { vec3 surfaces[]; };
layout(scalar, binding = kBindMediaRadiance) writeonly buffer Radiance { vec3 radiance[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  uint index = uint(pixel.y * media.camera.width + pixel.x);
  radiance[index] = surfaces[index] + inScattered[index];
}
