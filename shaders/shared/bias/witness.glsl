// Witness: a receiver is in shadow where a texel near it names a triangle whose surface, followed to the receiver as the
// light sees it, stands before the receiver (shared/sheet_walk.glsl). No parameter: a verdict of shadow has a real surface
// before the receiver, whatever the map's resolution.
//
//     lit  <=>  no texel around the receiver leads to a witness
//
// Asked are the 2 x 2 texels whose centres surround the receiver, the nearest first; with a reach of 4, where they have no
// witness, the 12 around them. A walk that is too long (kWalkAborted) leaves the texel to two-plane.
//
// A filter's tap asks for the point where its own ray meets the receiver's plane. What stands before that point but,
// followed on to the receiver, is its own surface or comes down to its plane shadows nothing: a curved surface lies before
// each of its planes somewhere, and so does the wall behind a floor.
#ifndef GNOMON_BIAS_WITNESS_GLSL
#define GNOMON_BIAS_WITNESS_GLSL

#include "shared/bias/two_plane.glsl"
#include "shared/lang.glsl"
#include "shared/sheet_walk.glsl"

GNOMON_SHARED_BEGIN

// What the walks of one receiver came to: for reports.
struct WalkTally {
  uint ends;   // kWalkReceiver .. kWalkFold, five bits each
  uint steps;  // of all walks; from bit 12 the longest, from bit 20 how many were aborted
};

GNOMON_FN WalkTally tallied(WalkTally tally, SheetWalk walk) {
  WalkTally sum = tally;
  if (walk.end < kWalkAborted) sum.ends += 1u << uint(5 * walk.end);
  uint longest = max(tally.steps >> 12u & 255u, uint(walk.steps));
  uint aborted = (tally.steps >> 20u) + (walk.end == kWalkAborted ? 1u : 0u);
  sum.steps = ((tally.steps & 4095u) + uint(walk.steps)) | (longest << 12u) | (aborted << 20u);
  return sum;
}

struct WitnessVerdict {
  bool lit;
  int slice;  // of the texel that decided: the witness's, else the one that holds the point
  ivec2 texel;
  WalkTally tally;
};

// Whether a texel's triangle is a witness against `target`. `isTap`: that is not the receiver's own point.
GNOMON_FN bool isWitness(LookupTables tables, Receiver receiver, PlacedTriangle own, vec3 target, bool isTap, uint id,
                         Ray ray, GNOMON_INOUT(WalkTally) tally) {
  PlacedTriangle caster = placedTriangle(tables, id);
  SheetWalk walk = walkSheet(tables, caster, alongRay(tables, ray), target, receiver.normalL, own, false);
  tally = tallied(tally, walk);
  if (walk.end == kWalkAborted) {
    Receiver asked = receiver;
    asked.posL = target;
    return !twoPlaneLit(tables, asked, caster, ray);
  }
  if (walk.end != kWalkWitness || !isTap) return walk.end == kWalkWitness;
  int onwards = walkSheet(tables, walk.at, walk.posL, receiver.posL, receiver.normalL, own, true).end;
  return onwards != kWalkReceiver && onwards != kWalkBehind;
}

// Offsets of the texels in the order they are asked: 0 .. 3 from the nearest of the inner four, whose nearest is `nearest`;
// then, skipping these, 4 .. 19 over the square of 4 x 4.
GNOMON_FN ivec2 witnessOffset(int i, ivec2 nearest) {
  if (i < 4) {
    return ivec2((i & 1) == 0 ? nearest.x : 1 - nearest.x, (i & 2) == 0 ? nearest.y : 1 - nearest.y);
  }
  return ivec2(((i - 4) & 3) - 1, ((i - 4) >> 2) - 1);
}

GNOMON_FN bool isInnerOffset(ivec2 offset) { return offset.x >= 0 && offset.x <= 1 && offset.y >= 0 && offset.y <= 1; }

// `point`: where `target` falls on the map, which covers it.
GNOMON_FN WitnessVerdict witnessVerdict(ShadowMap map, LookupTables tables, int reach, Receiver receiver, vec3 target,
                                        bool isTap, MapPoint point) {
  WitnessVerdict verdict;
  verdict.lit = true;
  verdict.slice = point.slice;
  verdict.texel = mapTexel(map, point.uv);
  verdict.tally.ends = 0u;
  verdict.tally.steps = 0u;
  PlacedTriangle own = placedTriangle(tables, receiver.id);
  vec2 counts = mapTexelCounts(map);
  vec2 position = vec2(point.uv.x * counts.x - 0.5f, point.uv.y * counts.y - 0.5f);
  ivec2 first = ivec2(int(floor(position.x)), int(floor(position.y)));
  vec2 fraction = vec2(position.x - float(first.x), position.y - float(first.y));
  ivec2 nearest = ivec2(fraction.x > 0.5f ? 1 : 0, fraction.y > 0.5f ? 1 : 0);
  int count = reach == 4 ? 20 : 4;
  for (int i = 0; i < count; ++i) {
    ivec2 offset = witnessOffset(i, nearest);
    if (i >= 4 && isInnerOffset(offset)) continue;
    // A centre's own texel is all that surrounds it.
    if (i < 4 && ((offset.x == 1 && fraction.x == 0.0f) || (offset.y == 1 && fraction.y == 0.0f))) continue;
    MapTexel found = mapTexelAcross(map, point.slice, ivec2(first.x + offset.x, first.y + offset.y), target);
    if (!found.held) continue;
    uint id = mapIdAt(tables, found.slice, found.texel);
    if (id == kNoId) continue;
    Ray ray = mapTexelRay(map, found.slice, mapTexelCenter(map, found.texel));
    if (isWitness(tables, receiver, own, target, isTap, id, ray, verdict.tally)) {
      verdict.lit = false;
      verdict.slice = found.slice;
      verdict.texel = found.texel;
      return verdict;
    }
  }
  return verdict;
}

GNOMON_SHARED_END
#endif
