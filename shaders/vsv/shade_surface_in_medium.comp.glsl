// Diffuse surfaces in a medium: the light is attenuated from the light to the surface, and from the surface to the eye.
#include "shared/media_pass.glsl"
#include "shared/shade.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) readonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindMedia) uniform Media { MediaUniforms media; };
layout(scalar, binding = kBindSurface) buffer Surface { vec3 surfaces[]; };
layout(scalar, binding = kBindEyeDepth) readonly buffer EyeDepth { float eyeDepth[]; };
layout(scalar, push_constant) uniform Push { DensityPush push; };

layout(constant_id = 0) const int kHeterogeneous = 0;

#include "vsv/light_depth_fetch.glsl"
#include "shadow/surface_radiance.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  uint index = uint(pixel.y * media.camera.width + pixel.x);
  PrimitiveId id = fetchPrimitive(pixel);
  vec3 color = vec3(0.0f);
  if (id.instancePlusOne != 0u) {
    vec3 position;
    SurfaceLight light = shadeSurface(pixel, id, visibility[index], position);
    float toEye = min(length(position - media.camera.eyeW), media.medium.reach);
    float toLight = length(towardsLight(shade, position));
    if (kHeterogeneous == 1) {
      toEye = eyeDepth[index];
      toLight = depthFromLight(push.reach, position - push.light.lightW);
    }
    color = light.albedo * (light.direct * transmittance(media.medium, toLight + toEye) +
                            light.ambient * transmittance(media.medium, toEye));
  }
  if (push.light.add == 1) color += surfaces[index];
  surfaces[index] = color;
}
