// Visibility by biases that know the scene's surfaces (shared/surface_bias.glsl): their tables, and a tap of `witness`.
// The including shader declares `shade`, `endMargin`, `idShift`, kMethod, kDiagnose, kStage, kWitnessReach,
// kMapKind and kMaskedScene.
#ifndef GNOMON_SURFACE_VISIBILITY_GLSL
#define GNOMON_SURFACE_VISIBILITY_GLSL

#include "shared/shade.glsl"

#include "shadow/fetch_channels.glsl"
#include "shadow/fetch_lookup_tables.glsl"
#include "shared/surface_bias.glsl"

#include "shadow/map_constants.glsl"

LookupTables lookupTables(ShadowMap map) {
  LookupTables tables;
  tables.frame = lightFrame;
  tables.positional = shade.positional;
  tables.endMargin = endMargin;
  tables.instanced = kInstanced;
  tables.idShift = idShift;
  tables.masked = kMaskedScene;
  tables.mapWidth = map.width;
  tables.mapHeight = map.height;
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
  WitnessVerdict verdict = litWithoutWalk(map, asked);
  if (kStage == kStageLists) {
    WitnessQuestion question = witnessQuestion(map, target, asked);
    TexelsToAsk ask = texelsToAsk(map, lookupTables(map), question, receiver.id, kWitnessReach);
    pixelDiagnosis.flags |= ask.beyond != 0u ? kPixelWalksAcross : ask.held != 0u ? kPixelWalks : 0u;
  } else {
    WitnessAsking asking = WitnessAsking(kWitnessReach, kFilter != kShadowFilterNone, kStage != kStageWalks);
    verdict = witnessVerdict(map, lookupTables(map), asking, receiver, target, asked);
  }
  lit = verdict.lit;
  if (kDiagnose == 1) {
    pixelDiagnosis.flags |= kPixelCovered | (lit ? kPixelLit : 0u);
    pixelDiagnosis.texel = packTexel(verdict.slice, verdict.texel);
    pixelDiagnosis.walkEnds = verdict.tally.ends;
    pixelDiagnosis.walkSteps = verdict.tally.steps;
  }
  return true;
}

#endif
