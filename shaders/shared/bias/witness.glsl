// Witness: a receiver is in shadow where a texel near it names a triangle whose surface, followed to the receiver as
// the light sees it, stands before the receiver (shared/sheet_walk.glsl). No parameter: a verdict of shadow has a real
// surface before the receiver, whatever the map's resolution.
//
//     lit  <=>  no texel around the receiver leads to a witness
//
// Asked are the 2 x 2 texels whose centres surround the receiver, the nearest first; with a reach of 4, where they have
// no witness, the 12 around them. A walk that is too long (kWalkAborted) leaves the texel to two-plane.
//
// A filter's tap asks for the point where its own ray meets the receiver's plane. What stands before that point but,
// followed on to the receiver, is its own surface or comes down to its plane shadows nothing: a curved surface lies
// before each of its planes somewhere, and so does the wall behind a floor.
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

// Offsets of the texels in the order they are asked: 0 .. 3 from the nearest of the inner four, which is `nearest`;
// then 4 .. 19 over the square of 4 x 4.
GNOMON_FN ivec2 witnessOffset(int i, ivec2 nearest) {
  if (i < 4) return ivec2((i & 1) == 0 ? nearest.x : 1 - nearest.x, (i & 2) == 0 ? nearest.y : 1 - nearest.y);
  return ivec2(((i - 4) & 3) - 1, ((i - 4) >> 2) - 1);
}

GNOMON_FN bool isInnerOffset(ivec2 offset) { return offset.x >= 0 && offset.x <= 1 && offset.y >= 0 && offset.y <= 1; }

// What one receiver asks for.
struct WitnessQuestion {
  vec3 target;  // the point
  int slice;    // where it falls
  ivec2 first;  // the texel before it
  ivec2 nearest;
  vec2 fraction;
  int crossing;      // which of the texels 1 .. 3 lies beyond the slice's edge, the first that does; 0: none
  MapTexel crossed;  // what another slice holds in its place
};

GNOMON_FN ivec2 wantedTexel(WitnessQuestion question, int i) {
  ivec2 offset = witnessOffset(i, question.nearest);
  return ivec2(question.first.x + offset.x, question.first.y + offset.y);
}

GNOMON_FN WitnessQuestion witnessQuestion(ShadowMap map, vec3 target, MapPoint point) {
  vec2 counts = mapTexelCounts(map);
  vec2 position = vec2(point.uv.x * counts.x - 0.5f, point.uv.y * counts.y - 0.5f);
  WitnessQuestion question;
  question.target = target;
  question.slice = point.slice;
  question.first = ivec2(int(floor(position.x)), int(floor(position.y)));
  question.fraction = vec2(position.x - float(question.first.x), position.y - float(question.first.y));
  question.nearest = ivec2(question.fraction.x > 0.5f ? 1 : 0, question.fraction.y > 0.5f ? 1 : 0);
  bool holds1 = mapHoldsTexel(map, question.slice, wantedTexel(question, 1));
  bool holds2 = mapHoldsTexel(map, question.slice, wantedTexel(question, 2));
  bool holds3 = mapHoldsTexel(map, question.slice, wantedTexel(question, 3));
  question.crossing = !holds1 ? 1 : !holds2 ? 2 : !holds3 ? 3 : 0;
  question.crossed = mapTexelAcross(map, question.slice, wantedTexel(question, question.crossing), target);
  return question;
}

// Texel i. Of those beyond the slice's edge one is looked up in another slice: on lavapipe, which runs what one pixel
// of eight needs for all, to look up each took two fifths of the pass.
GNOMON_FN MapTexel askedTexel(ShadowMap map, WitnessQuestion question, int i) {
  MapTexel asked;
  asked.slice = question.slice;
  asked.texel = wantedTexel(question, i);
  asked.held = mapHoldsTexel(map, question.slice, asked.texel);
  if (i != 0 && i == question.crossing) asked = question.crossed;
  return asked;
}

// Which of the texels `from` .. `to` - 1 name a triangle that is neither the receiver's nor what one before them names:
// bits. Most receivers have none, and nothing more to do.
GNOMON_FN uint texelsToAsk(ShadowMap map, LookupTables tables, WitnessQuestion question, uint ownId, int from, int to) {
  uint bits = 0u;
  uint lastId = ownId;
  uint lastButOne = ownId;
  for (int i = from; i < to; ++i) {
    ivec2 offset = witnessOffset(i, question.nearest);
    // A centre's own texel is all that surrounds it.
    bool outside = (offset.x == 1 && question.fraction.x == 0.0f) || (offset.y == 1 && question.fraction.y == 0.0f);
    if (i < 4 ? outside : isInnerOffset(offset)) continue;
    MapTexel found = askedTexel(map, question, i);
    if (!found.held) continue;
    uint id = mapIdAt(tables, found.slice, found.texel);
    if (id == kNoId || id == ownId || id == lastId || id == lastButOne) continue;
    bits |= 1u << uint(i);
    lastButOne = lastId;
    lastId = id;
  }
  return bits;
}

// A search through all texels to ask: one loop, in which each turn goes one triangle further, be it of this walk or the
// first of the next, so that of pixels that are shaded together none waits for another's walk to end.
struct WitnessSearch {
  uint pending;  // bits
  int texel;     // that walks
  vec3 along;    // its ray
  SheetWalk walk;
  WalkTally tally;
};

GNOMON_FN WitnessSearch searchOn(ShadowMap map, LookupTables tables, WitnessQuestion question, Receiver receiver,
                                 PlacedTriangle own, WitnessSearch search) {
  WitnessSearch next = search;
  if (search.walk.end != kWalkOn) {
    next.texel = findLSB(search.pending);
    next.pending = search.pending & (search.pending - 1u);
    MapTexel found = askedTexel(map, question, next.texel);
    next.along = alongRay(tables, mapTexelRay(map, found.slice, mapTexelCenter(map, found.texel)));
    next.walk = beginWalk(placedTriangle(tables, mapIdAt(tables, found.slice, found.texel)));
  }
  next.walk = walkOn(tables, next.walk, next.along, question.target, receiver.normalL, own, false);
  return next;
}

// Whether what shadows a tap's point is the receiver's own surface, or comes down to the receiver's plane.
GNOMON_FN bool belongsToReceiver(LookupTables tables, Receiver receiver, PlacedTriangle own, SheetWalk walk) {
  int end = walkSheet(tables, walk.at, walk.posL, receiver.posL, receiver.normalL, own, true).end;
  return end == kWalkReceiver || end == kWalkBehind;
}

// `point`: where `target` falls on the map, which covers it. `isTap`: that is not the receiver's own point.
GNOMON_FN WitnessVerdict witnessVerdict(ShadowMap map, LookupTables tables, int reach, Receiver receiver, vec3 target,
                                        bool isTap, MapPoint point) {
  WitnessQuestion question = witnessQuestion(map, target, point);
  PlacedTriangle own = placedTriangle(tables, receiver.id);
  WitnessSearch search;
  search.pending = texelsToAsk(map, tables, question, receiver.id, 0, 4);
  if (reach == 4) search.pending |= texelsToAsk(map, tables, question, receiver.id, 4, 20);
  search.texel = 0;
  search.along = target;
  search.walk = beginWalk(own);
  search.walk.end = kWalkBehind;
  search.tally.ends = 0u;
  search.tally.steps = 0u;
  bool shadowed = false;
  while (!shadowed && search.pending != 0u) {
    // Until a walk claims something, or all are at their end.
    bool claims = false;
    while (!claims && (search.pending != 0u || search.walk.end == kWalkOn)) {
      search = searchOn(map, tables, question, receiver, own, search);
      claims = search.walk.end == kWalkWitness || (search.walk.end == kWalkAborted && !search.walk.planesLit);
      bool settled = search.walk.end != kWalkOn && search.walk.end != kWalkWitness;
      if (settled) search.tally = tallied(search.tally, search.walk);
    }
    if (claims && tables.masked == 1 && search.walk.end == kWalkWitness && isHoleOf(tables, search.walk, target)) {
      search.walk.end = kWalkHole;
      claims = false;
      search.tally = tallied(search.tally, search.walk);
    }
    if (claims && search.walk.end == kWalkWitness) search.tally = tallied(search.tally, search.walk);
    shadowed = claims && !(isTap && belongsToReceiver(tables, receiver, own, search.walk));
    if (!shadowed) search.walk.end = kWalkBehind;
  }
  WitnessVerdict verdict;
  verdict.lit = !shadowed;
  MapTexel decided = askedTexel(map, question, search.texel);
  verdict.slice = shadowed ? decided.slice : point.slice;
  verdict.texel = shadowed ? decided.texel : mapTexel(map, point.uv);
  verdict.tally = search.tally;
  return verdict;
}

GNOMON_SHARED_END
#endif
