// What a texel of a map stores is a set of channels, and a tap is what one texel says.
//
// A channel is a bit, a binding and a member of Tap here; its row in src/shadow/channel.cpp says what draws it,
// shadow/store_channels.glsl how a fragment stores it, shadow/fetch_channels.glsl how a tap fetches it. A bias asks for
// it in its own row (src/shadow/bias.cpp), a user's in its file (//! channels:).
#ifndef GNOMON_CHANNELS_GLSL
#define GNOMON_CHANNELS_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"
#include "shared/scene.glsl"

GNOMON_SHARED_BEGIN

const int kChannelDepth = 1;        // the nearest depth
const int kChannelSecondDepth = 2;  // the nearest depth behind it
const int kChannelBackDepth = 4;    // the nearest back face of solids; sheets as they are
const int kChannelIds = 8;          // which triangle of which instance the nearest depth is of
const int kChannelSecondIds = 16;   // and the second depth

// Array textures, a slice for each slice of the map. There is room for 6 up to kBindRadiance.
const int kBindMapDepth = kBindFirstFree;
const int kBindSecondDepth = kBindFirstFree + 1;
const int kBindBackDepth = kBindFirstFree + 2;
const int kBindIds = kBindFirstFree + 3;
const int kBindSecondIds = kBindFirstFree + 4;

// How a slice's triangles are drawn, for fragment shaders.
const int kPassNearest = 0;  // the depth test keeps the nearest of all
const int kPassBlend = 1;    // the nearest behind the first depth layer: the depth test lets through, a blend keeps
const int kPassPeel = 2;     // the same: the shader lets through, the depth test keeps
const int kPassOrdered = 3;  // both layers: the shader keeps (shadow/store_in_order.glsl)

// One look-up: a texel, the ray through its centre, and what its channels hold. A channel that the map lacks, or that
// nobody asks for, is as in a texel in which nothing was drawn.
struct Tap {
  int slice;  // the array slice
  ivec2 texel;
  Ray ray;
  float z1;     // nearest depth; 1 where there is none
  float z2;     // nearest depth beyond z1; 1 where there is none
  float zBack;  // nearest depth of a back face; 1 where there is none
  // Of the triangles with depths z1 and z2, numbered as in shared/triangle_ids.glsl; 0 where there is none.
  uint id1;
  uint id2;
};

GNOMON_FN Tap emptyTap(int slice, ivec2 texel, Ray ray) {
  Tap tap;
  tap.slice = slice;
  tap.texel = texel;
  tap.ray = ray;
  tap.z1 = 1.0f;
  tap.z2 = 1.0f;
  tap.zBack = 1.0f;
  tap.id1 = 0u;
  tap.id2 = 0u;
  return tap;
}

// Nothing was drawn in the texel: there is no occluder.
GNOMON_FN bool holdsNothing(Tap tap) { return tap.z1 >= 1.0f && tap.zBack >= 1.0f; }

GNOMON_SHARED_END
#endif
