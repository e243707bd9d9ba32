// The part of a pixel's visibility that does not ask where its receiver comes from: receiver -> taps -> how much of
// them is lit. The including shader declares `shade` and `filterParams`, and before shared/map.glsl the constants
// kMethod, kDiagnose and kMapKind; for biases that follow the scene's surfaces it includes surface_visibility.glsl
// first.
#ifndef GNOMON_MAP_VISIBILITY_GLSL
#define GNOMON_MAP_VISIBILITY_GLSL

#include "shared/bias.glsl"
#include "shared/filter.glsl"
#include "shared/shade.glsl"

#include "shadow/fetch_tap.glsl"

#include "shadow/map_constants.glsl"

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
#ifdef GNOMON_SURFACE_VISIBILITY_GLSL
    if (kMethod == kBiasWitness) {
      bool tapIsLit;
      if (!witnessTap(map, receiver, point, wanted.at, tapIsLit, pixelDiagnosis)) continue;
      if (tapIsLit) lit += wanted.weight;
      weights += wanted.weight;
      continue;
    }
#endif
    MapTexel found;
    found.slice = point.slice;
    found.texel = mapTexel(map, point.uv);
    found.held = true;
    if (kFilter != kShadowFilterNone) {
      found = mapTexelAcross(map, point.slice, wanted.texel, receiver.posL);
      if (!found.held) continue;
    }
    Tap tap = fetchTap(map, found.slice, found.texel);
    bool known;
    bool tapLit;
#ifdef GNOMON_SURFACE_VISIBILITY_GLSL
    if (kMethod >= kFirstSurfaceBias)
      tapLit = surfaceBiasLit(kMethod, map, lookupTables(map), shade.bias, receiver, tap, known);
    else
#endif
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

// What lies beyond the map is lit.
float receiverVisibility(ShadowMap map, Receiver receiver, ivec2 pixel, inout PixelDiagnosis pixelDiagnosis) {
  pixelDiagnosis.flags = kPixelShaded;
  receiver = biasReceiver(kMethod, map, shade.bias, receiver);
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return 1.0f;
  return filteredVisibility(map, receiver, point, pixel, pixelDiagnosis);
}

#endif
