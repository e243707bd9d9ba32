// A receiver's visibility by a map with nothing bound: what `gnomon export` and the GLSL headers for other renderers
// are made of (src/lab/export). What is only declared here is defined by each language, or by whoever includes the
// headers.
const int kMethod = 0;    // kBias*
const int kMapKind = 0;   // kMap*
const int kDiagnose = 0;
const int kMaskedScene = 0;
const int kInstanced = 0;
const int kStage = 0;
const int kWitnessReach = 2;  // texels a side that witness asks
const int kChannels = 1;
const int kFilter = 0;    // kShadowFilter*
const int kTapCount = 1;  // of the filter

#include "shared/filter.glsl"
#include "shared/map.glsl"
#include "shared/shade.glsl"

// A texel's depths, from 0 at the near end to 1 at the far one and where nothing was drawn, and its triangles' numbers.
float fetchDepth(int slice, ivec2 texel);
float fetchSecondDepth(int slice, ivec2 texel);
float fetchBackDepth(int slice, ivec2 texel);
uint fetchId(int slice, ivec2 texel);
uint fetchSecondId(int slice, ivec2 texel);

#define GNOMON_LOOKUP_TABLES
#include "shared/lookup_tables.glsl"

uint mapIdAt(LookupTables tables, int slice, ivec2 texel) { return fetchId(slice, texel); }
float mapDepthAt(LookupTables tables, int slice, ivec2 texel) { return fetchDepth(slice, texel); }
uint idWithin(LookupTables tables, int slice, ivec2 texel) {
  return mapIdAt(tables, slice,
                 ivec2(clamp(texel.x, 0, tables.mapWidth - 1), clamp(texel.y, 0, tables.mapHeight - 1)));
}
uvec4 mapIdsAround(LookupTables tables, int slice, ivec2 first) {
  return uvec4(idWithin(tables, slice, first), idWithin(tables, slice, ivec2(first.x + 1, first.y)),
               idWithin(tables, slice, ivec2(first.x, first.y + 1)),
               idWithin(tables, slice, ivec2(first.x + 1, first.y + 1)));
}

#include "shadow/surface_visibility.glsl"

#include "shadow/map_visibility.glsl"

// The receiver at a point of a surface, in the world, with its unit geometric normal turned to the light's side. `id`
// is that of its triangle, for biases that ask for ids; else 0.
Receiver receiverAt(LightFrame frame, vec3 posW, vec3 normalW, uint id) {
  Receiver receiver;
  receiver.posL = lightFromWorld(frame, posW);
  receiver.normalL = directionFromWorld(frame, normalW);
  receiver.id = id;
  return receiver;
}
