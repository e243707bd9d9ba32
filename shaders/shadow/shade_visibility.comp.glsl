// One visibility shader for every map, bias and filter: G-buffer pixel -> receiver -> taps -> how much of them is lit.
//
// The method, the map's kind and its slice count are specialization constants, so that each pipeline holds one bias on
// one map only, and reads the matrices of a single layer from constant addresses. kDiagnose also writes what decided
// the pixel, of one tap; timings are taken without it.
layout(constant_id = 0) const int kMethod = 0;   // kBias*
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_BIAS_METHOD kMethod
#define GNOMON_MAP_KIND kMapKind

#include "shared/bias.glsl"
#include "shared/filter.glsl"
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 1) const int kDiagnose = 0;
layout(constant_id = 3) const int kSliceCount = 1;
layout(constant_id = 6) const int kFilter = kShadowFilterNone;  // kShadowFilter*
layout(constant_id = 7) const int kTapCount = 1;

layout(push_constant, scalar) uniform Push { FilterParams filterParams; };
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindDiagnosis) writeonly buffer Diagnosis { PixelDiagnosis diagnosis[]; };

#include "shadow/fetch_channels.glsl"
#include "shadow/receiver_fetch.glsl"

ShadowMap specializedMap() {
  ShadowMap map = shadowMap;
  map.sliceCount = kSliceCount;
  return map;
}

// The share of the filter's taps that are lit; taps that no slice holds count for nothing. Without a filter the one tap
// is the texel that holds the receiver, and with kDiagnose what it said. One path for all: the bias is compiled once,
// and compiling is what a run waits for.
float filteredVisibility(ShadowMap map, Receiver receiver, MapPoint point, ivec2 pixel,
                         inout PixelDiagnosis pixelDiagnosis) {
  vec2 position = point.uv * mapTexelCounts(map);
  uint seed = pixelSeed(pixel);
  float lit = 0.0f;
  float weights = 0.0f;
  for (int i = 0; i < kTapCount; ++i) {
    bool filterKnown;
    FilterTap wanted = filterTap(kFilter, filterParams, position, seed, i, filterKnown);
    if (!filterKnown) return kUnknownVisibility;
    MapTexel found;
    found.slice = point.slice;
    found.texel = mapTexel(map, point.uv);
    found.held = true;
    if (kFilter != kShadowFilterNone) found = mapTexelAcross(map, point.slice, wanted.texel, receiver.posL);
    if (!found.held) continue;
    Tap tap = fetchTap(map, found.slice, found.texel);
    bool known;
    bool tapLit = biasLit(kMethod, map, shade.bias, receiver, tap, known);
    if (kDiagnose == 1) {
      pixelDiagnosis.flags |= kPixelCovered | (tapLit ? kPixelLit : 0u) | (known ? 0u : kPixelUnknown);
      if (receiverPlaneDepth(map, tap.slice, receiver, tap.ray).grazing) pixelDiagnosis.flags |= kPixelGrazing;
      pixelDiagnosis.texel = packTexel(tap.slice, tap.texel);
    }
    if (!known) return kUnknownVisibility;
    if (tapLit) lit += wanted.weight;
    weights += wanted.weight;
  }
  return weights > 0.0f ? lit / weights : 1.0f;
}

// Empty pixels and those beyond the map are lit; a surface that faces away is not.
float shadePixel(ivec2 pixel, PrimitiveId id, inout PixelDiagnosis pixelDiagnosis) {
  if (id.instancePlusOne == 0u) return 1.0f;
  Receiver receiver;
  if (!fetchReceiver(pixel, id, receiver)) return 0.0f;
  pixelDiagnosis.flags = kPixelShaded;
  ShadowMap map = specializedMap();
  receiver = biasReceiver(kMethod, map, shade.bias, receiver);
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return 1.0f;
  return filteredVisibility(map, receiver, point, pixel, pixelDiagnosis);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PixelDiagnosis pixelDiagnosis;
  pixelDiagnosis.texel = 0u;
  pixelDiagnosis.flags = 0u;
  visibility[index] = shadePixel(pixel, fetchPrimitive(pixel), pixelDiagnosis);
  if (kDiagnose == 1) diagnosis[index] = pixelDiagnosis;
}
