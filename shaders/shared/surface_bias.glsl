// The biases that know surfaces: beside a tap they look up other texels, and the triangles that texels name
// (shared/lookup_tables.glsl). The others are in shared/bias.glsl.
#ifndef GNOMON_SURFACE_BIAS_GLSL
#define GNOMON_SURFACE_BIAS_GLSL

#include "shared/bias.glsl"
#include "shared/lang.glsl"
#include "shared/lookup_tables.glsl"

#include "shared/bias/priority_buffer.glsl"
#include "shared/bias/two_plane.glsl"
#include "shared/bias/witness.glsl"

GNOMON_SHARED_BEGIN

// Whether a texel lights the receiver. An unknown method sets `known` to false. `witness` is none of these: it asks for
// texels of its own (witnessVerdict).
GNOMON_FN bool surfaceBiasLit(int method, ShadowMap map, LookupTables tables, BiasParams params, Receiver receiver,
                              Tap tap, GNOMON_OUT(bool) known) {
  known = true;
  if (holdsNothing(tap)) return true;
  if (biasMethod(method) == kBiasTwoPlaneDepth) return twoPlaneDepthLit(map, tables, receiver, tap);
  known = biasMethod(method) == kBiasTwoPlane || biasMethod(method) == kBiasPriorityBuffer ||
          biasMethod(method) == kBiasPriorityDepth;
  if (!known) return false;
  if (tap.id1 == kNoId || receiver.id == kNoId) return true;
  PlacedTriangle caster = placedTriangle(tables, tap.id1);
  PlacedTriangle own = placedTriangle(tables, receiver.id);
  if (biasMethod(method) == kBiasTwoPlane) {
    if (caster.triangle == own.triangle && caster.instance == own.instance) return true;
    return twoPlaneLit(tables, receiver, caster, tap.ray);
  }
  if (isSamePriority(tables, params.priorityId, caster, own)) return true;
  return biasMethod(method) == kBiasPriorityDepth && noneLit(map, receiver, tap);
}

GNOMON_SHARED_END
#endif
