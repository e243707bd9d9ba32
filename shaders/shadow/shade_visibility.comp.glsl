// One visibility shader for every map, bias and filter: G-buffer pixel -> receiver -> taps -> how much of them is lit.
//
// The method, the map's kind and its slice count are specialization constants, so that each pipeline holds one bias on
// one map only, and reads the matrices of a single layer from constant addresses. kDiagnose also writes what decided
// the pixel, of one tap; timings are taken without it.
layout(constant_id = 0) const int kMethod = 0;   // kBias*
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_BIAS_METHOD kMethod
#define GNOMON_MAP_KIND kMapKind

#include "shared/filter.glsl"
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"
#include "shadow/fetch_channels.glsl"
#include "shadow/fetch_lookup_tables.glsl"
#include "shared/surface_bias.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 1) const int kDiagnose = 0;
layout(constant_id = 3) const int kSliceCount = 1;
layout(constant_id = 6) const int kFilter = kShadowFilterNone;  // kShadowFilter*
layout(constant_id = 7) const int kTapCount = 1;

layout(constant_id = 9) const int kMaskedScene = 1;

layout(push_constant, scalar) uniform Push {
  FilterParams filterParams;
  float endMargin;  // LookupTables
  uint idShift;
};
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindDiagnosis) writeonly buffer Diagnosis { PixelDiagnosis diagnosis[]; };

#include "shadow/receiver_fetch.glsl"

ShadowMap specializedMap() {
  ShadowMap map = shadowMap;
  map.sliceCount = kSliceCount;
  return map;
}

LookupTables lookupTables() {
  LookupTables tables;
  tables.frame = lightFrame;
  tables.positional = shade.positional;
  tables.endMargin = endMargin;
  tables.instanced = kInstanced;
  tables.idShift = idShift;
  tables.masked = kMaskedScene;
  tables.mapWidth = shadowMap.width;
  tables.mapHeight = shadowMap.height;
  return tables;
}

// `witness` for one tap of a filter: what it asks for is the point of the receiver's plane on the tap's own ray, or
// without a filter the receiver's own. False where no slice holds it.
bool witnessTap(ShadowMap map, Receiver receiver, MapPoint point, vec2 at, out bool lit,
                inout PixelDiagnosis pixelDiagnosis) {
  vec3 target = receiver.posL;
  MapPoint asked = point;
  lit = true;
  if (kFilter != kShadowFilterNone) {
    Ray ray = mapTexelRay(map, point.slice, at / mapTexelCounts(map));
    target = receiverPlaneDepth(map, point.slice, receiver, ray).posL;
    asked.uv = at / mapTexelCounts(map);
    if (!mapHoldsTexel(map, asked.slice, ivec2(floor(at)))) {
      asked = mapProject(map, target);
      if (!asked.covered) return false;
    }
  }
  WitnessVerdict verdict = witnessVerdict(map, lookupTables(), shade.bias.witnessReach, receiver, target,
                                          kFilter != kShadowFilterNone, asked);
  lit = verdict.lit;
  if (kDiagnose == 1) {
    pixelDiagnosis.flags |= kPixelCovered | (lit ? kPixelLit : 0u);
    pixelDiagnosis.texel = packTexel(verdict.slice, verdict.texel);
    pixelDiagnosis.walkEnds = verdict.tally.ends;
    pixelDiagnosis.walkSteps = verdict.tally.steps;
  }
  return true;
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
    if (kMethod == kBiasWitness) {
      bool tapIsLit;
      if (!witnessTap(map, receiver, point, wanted.at, tapIsLit, pixelDiagnosis)) continue;
      if (tapIsLit) lit += wanted.weight;
      weights += wanted.weight;
      continue;
    }
    MapTexel found;
    found.slice = point.slice;
    found.texel = mapTexel(map, point.uv);
    found.held = true;
    if (kFilter != kShadowFilterNone) found = mapTexelAcross(map, point.slice, wanted.texel, receiver.posL);
    if (!found.held) continue;
    Tap tap = fetchTap(map, found.slice, found.texel);
    bool known;
    bool tapLit;
    if (kMethod >= kFirstSurfaceBias)
      tapLit = surfaceBiasLit(kMethod, map, lookupTables(), shade.bias, receiver, tap, known);
    else
      tapLit = biasLit(kMethod, map, shade.bias, receiver, tap, known);
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
  if ((kChannels & (kChannelIds | kChannelSecondIds)) != 0) {
    receiver.id = id.triangle + 1u;
    if (kInstanced == 1) {
      uint instance = id.instancePlusOne - 1u;
      receiver.id = instances[instance].firstId + (id.triangle - instances[instance].firstTriangle);
    }
  }
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
  pixelDiagnosis.walkEnds = 0u;
  pixelDiagnosis.walkSteps = 0u;
  visibility[index] = shadePixel(pixel, fetchPrimitive(pixel), pixelDiagnosis);
  if (kDiagnose == 1) diagnosis[index] = pixelDiagnosis;
}
