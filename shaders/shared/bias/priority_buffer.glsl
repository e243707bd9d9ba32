// Priority buffer: the map stores what a texel sees instead of how far it is, and a receiver is lit where that is
// itself. Hourcade, Nicolas, "Algorithms for Antialiased Cast Shadows", Computers & Graphics 9(3), 1985.
//
//   priority-buffer  lit where the texel holds the receiver's own number, else in shadow
//   priority-depth   lit there, and where the numbers differ as depth says, without a bias
//
// priorityId chooses whose number: the triangle's, its connected surface's or its instance's. A surface that has one
// number never shadows itself, where it should not, and where it should.
#ifndef GNOMON_BIAS_PRIORITY_BUFFER_GLSL
#define GNOMON_BIAS_PRIORITY_BUFFER_GLSL

#include "shared/bias/none.glsl"
#include "shared/lang.glsl"
#include "shared/lookup_tables.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN bool isSamePriority(LookupTables tables, int priorityId, PlacedTriangle a, PlacedTriangle b) {
  if (priorityId == kPriorityTriangle) return a.triangle == b.triangle && a.instance == b.instance;
  TriangleFacts ofA = triangleFacts(tables, a.triangle);
  TriangleFacts ofB = triangleFacts(tables, b.triangle);
  bool sameInstance = tables.instanced == 1 ? a.instance == b.instance : ofA.instance == ofB.instance;
  return priorityId == kPriorityInstance ? sameInstance : a.instance == b.instance && ofA.sheet == ofB.sheet;
}

GNOMON_SHARED_END
#endif
