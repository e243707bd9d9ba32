// The shaded picture: diffuse surfaces, one light with its visibility, a little ambient light.
#include "shared/shade.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) readonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindRadiance) writeonly buffer Radiance { vec3 radiance[]; };

#include "shadow/surface_radiance.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PrimitiveId id = fetchPrimitive(pixel);
  float visible = visibility[index];
  vec3 color = vec3(0.0f);
  vec3 position;
  if (id.instancePlusOne != 0u) color = seenColor(shadeSurface(pixel, id, visible, position), visible);
  radiance[index] = color;
}
