// Visibility by a shadow volume: G-buffer pixel -> receiver -> voxel -> its bit. Reads and writes what
// shadow/shade_visibility.comp.glsl does; the texel of the diagnosis is the column.
#define GNOMON_MAP_KIND kMapEpipolar

#include "shared/shade.glsl"
#include "shared/volume.glsl"
#include "shared/volume_lookup.glsl"

#include "scene/surface_fetch.glsl"
#include "shadow/store_visibility.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 0) const int kMethod = kBiasNone;
layout(constant_id = 1) const int kDiagnose = 0;

layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindBits) readonly buffer Bits { uint words[]; };
layout(scalar, binding = kBindDiagnosis) writeonly buffer Diagnosis { PixelDiagnosis diagnosis[]; };

#include "shadow/receiver_fetch.glsl"

bool isOccluded(EpipolarGrid grid, int voxel, ivec2 column) {
  uint texel = epipolarTexelIndex(grid, voxel, column.x, column.y / kPhiBits);
  int bit = column.y % kPhiBits;
  return (words[texel * 4u + uint(bit / 32)] >> uint(bit % 32) & 1u) != 0u;
}

float shadePixel(ivec2 pixel, PrimitiveId id, inout PixelDiagnosis pixelDiagnosis) {
  if (id.instancePlusOne == 0u) return 1.0f;
  Receiver receiver;
  if (!fetchReceiver(pixel, id, receiver)) return 0.0f;
  pixelDiagnosis.flags = kPixelShaded;
  ShadowMap map = shadowMap;
  map.sliceCount = 1;
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return 1.0f;
  ivec2 column = mapTexel(map, point.uv);
  Ray ray = mapTexelRay(map, 0, mapTexelCenter(map, column));
  bool known;
  int voxel = decidingVoxel(kMethod, map, shade.bias, receiver, ray, known);
  bool lit = voxel < 0 || !isOccluded(map.epipolar, voxel, column);
  if (kDiagnose == 1) {
    pixelDiagnosis.flags |= kPixelCovered | (lit ? kPixelLit : 0u) | (known ? 0u : kPixelUnknown);
    if (receiverPlaneDepth(map, 0, receiver, ray).grazing) pixelDiagnosis.flags |= kPixelGrazing;
    pixelDiagnosis.texel = packTexel(0, column);
  }
  return known ? (lit ? 1.0f : 0.0f) : kUnknownVisibility;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PixelDiagnosis pixelDiagnosis;
  pixelDiagnosis.texel = 0u;
  pixelDiagnosis.flags = 0u;
  pixelDiagnosis.walkEnds = 0u;
  pixelDiagnosis.walkSteps = 0u;
  storeVisibility(pixel, shade.camera.width, shadePixel(pixel, fetchPrimitive(pixel), pixelDiagnosis));
  if (kDiagnose == 1) diagnosis[index] = pixelDiagnosis;
}
