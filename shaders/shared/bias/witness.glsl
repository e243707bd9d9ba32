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
  int crossing;      // a texel beyond the slice's edge that is asked now; -1: none
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
  question.crossing = -1;
  question.crossed.slice = point.slice;
  question.crossed.texel = question.first;
  question.crossed.held = false;
  return question;
}

GNOMON_FN bool isWanted(WitnessQuestion question, int i) {
  ivec2 offset = witnessOffset(i, question.nearest);
  // A centre's own texel is all that surrounds it.
  bool outside = (offset.x == 1 && question.fraction.x == 0.0f) || (offset.y == 1 && question.fraction.y == 0.0f);
  return i < 4 ? !outside : !isInnerOffset(offset);
}

// Texel i: of the receiver's slice, or what is known of it in another.
GNOMON_FN MapTexel askedTexel(ShadowMap map, WitnessQuestion question, int i) {
  MapTexel asked;
  asked.slice = question.slice;
  asked.texel = wantedTexel(question, i);
  asked.held = mapHoldsTexel(map, question.slice, asked.texel);
  if (i == question.crossing) asked = question.crossed;
  return asked;
}

// Which texels there are to ask, as bits.
struct TexelsToAsk {
  uint held;    // of the receiver's slice, whose triangle is neither the receiver's nor what one before them names
  uint beyond;  // across the slice's edge
};

// An id among those that are known already.
struct KnownIds {
  uint own, before1, before2, before3;  // the receiver's, and the last of others
};

GNOMON_FN bool isKnownId(KnownIds seen, uint id) {
  return id == kNoId || id == seen.own || id == seen.before1 || id == seen.before2 || id == seen.before3;
}

GNOMON_FN TexelsToAsk withTexel(TexelsToAsk ask, bool held, bool isSeen, int i) {
  TexelsToAsk more = ask;
  more.held |= held && !isSeen ? 1u << uint(i) : 0u;
  more.beyond |= held ? 0u : 1u << uint(i);
  return more;
}

GNOMON_FN KnownIds withId(KnownIds seen, uint id) {
  KnownIds more = seen;
  more.before3 = seen.before2;
  more.before2 = seen.before1;
  more.before1 = id;
  return more;
}

// Most receivers have none, and nothing more to do.
GNOMON_FN TexelsToAsk texelsToAsk(ShadowMap map, LookupTables tables, WitnessQuestion question, uint ownId, int reach) {
  TexelsToAsk ask;
  ask.held = 0u;
  ask.beyond = 0u;
  KnownIds seen;
  seen.own = ownId;
  seen.before1 = ownId;
  seen.before2 = ownId;
  seen.before3 = ownId;
  uvec4 ids = mapIdsAround(tables, question.slice, question.first);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = witnessOffset(i, question.nearest);
    uint above = offset.x == 1 ? ids.y : ids.x;
    uint below = offset.x == 1 ? ids.w : ids.z;
    uint id = offset.y == 1 ? below : above;
    bool held = mapHoldsTexel(map, question.slice, wantedTexel(question, i));
    if (isWanted(question, i)) ask = withTexel(ask, held, isKnownId(seen, id), i);
    if (held) seen = withId(seen, id);
  }
  if (reach != 4) return ask;
  for (int i = 4; i < 20; ++i) {
    if (!isWanted(question, i)) continue;
    ivec2 texel = wantedTexel(question, i);
    bool held = mapHoldsTexel(map, question.slice, texel);
    uint id = held ? mapIdAt(tables, question.slice, texel) : kNoId;
    ask = withTexel(ask, held, isKnownId(seen, id), i);
    if (held) seen = withId(seen, id);
  }
  return ask;
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

GNOMON_FN WitnessVerdict litWithoutWalk(ShadowMap map, MapPoint point) {
  WitnessVerdict verdict;
  verdict.lit = true;
  verdict.slice = point.slice;
  verdict.texel = mapTexel(map, point.uv);
  verdict.tally.ends = 0u;
  verdict.tally.steps = 0u;
  return verdict;
}

// How `witness` is asked.
struct WitnessAsking {
  int reach;         // texels a side
  bool isTap;        // not for the receiver's own point
  bool crossesEdge;  // false: no texel beyond the slice's edge is wanted, which need not be looked for
};

GNOMON_FN WitnessAsking askingOf(int reach) {
  WitnessAsking asking;
  asking.reach = reach;
  asking.isTap = false;
  asking.crossesEdge = true;
  return asking;
}

// `point`: where `target` falls on the map, which covers it. Of what texelsToAsk() has nothing for, the verdict is
// litWithoutWalk().
GNOMON_FN WitnessVerdict witnessVerdict(ShadowMap map, LookupTables tables, WitnessAsking asking, Receiver receiver,
                                        vec3 target, MapPoint point) {
  WitnessQuestion question = witnessQuestion(map, target, point);
  PlacedTriangle own = placedTriangle(tables, receiver.id);
  TexelsToAsk ask = texelsToAsk(map, tables, question, receiver.id, asking.reach);
  if (!asking.crossesEdge) ask.beyond = 0u;
  WitnessVerdict verdict = litWithoutWalk(map, point);
  WitnessSearch search;
  search.pending = ask.held;
  search.texel = 0;
  search.along = target;
  search.walk = beginWalk(own);
  search.walk.end = kWalkBehind;
  search.tally = verdict.tally;
  bool shadowed = false;
  while (!shadowed && (search.pending | ask.beyond) != 0u) {
    // One texel beyond the edge goes with the others: on lavapipe, which runs what one pixel of eight needs for all, to
    // look up each by itself would cost all pixels three look-ups.
    bool isFree = question.crossing < 0 || (search.pending & (1u << uint(question.crossing))) == 0u;
    if (asking.crossesEdge && isFree && ask.beyond != 0u) {
      question.crossing = findLSB(ask.beyond);
      ask.beyond &= ask.beyond - 1u;
      question.crossed = mapTexelAcross(map, question.slice, wantedTexel(question, question.crossing), target);
      uint id = kNoId;
      if (question.crossed.held) id = mapIdAt(tables, question.crossed.slice, question.crossed.texel);
      if (id != kNoId && id != receiver.id) search.pending |= 1u << uint(question.crossing);
    }
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
    shadowed = claims && !(asking.isTap && belongsToReceiver(tables, receiver, own, search.walk));
    if (!shadowed) search.walk.end = kWalkBehind;
  }
  MapTexel decided = askedTexel(map, question, search.texel);
  verdict.tally = search.tally;
  if (shadowed) {
    verdict.lit = false;
    verdict.slice = decided.slice;
    verdict.texel = decided.texel;
  }
  return verdict;
}

GNOMON_SHARED_END
#endif
