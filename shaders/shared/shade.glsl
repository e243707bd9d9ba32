// Bindings and structs of the visibility pass.
#ifndef GNOMON_SHADE_GLSL
#define GNOMON_SHADE_GLSL

#include "shared/bias_params.glsl"
#include "shared/channels.glsl"
#include "shared/lang.glsl"
#include "shared/light_frame.glsl"
#include "shared/map.glsl"
#include "shared/plane_view.glsl"
#include "shared/scene.glsl"

GNOMON_SHARED_BEGIN

const int kBindRadiance = 15;    // vec3 a pixel
const int kBindShade = 29;       // ShadeUniforms
const int kBindVisibility = 30;  // float a pixel
const int kBindDiagnosis = 31;   // PixelDiagnosis a pixel
// Of the pixels that are left to a second dispatch of the visibility pass.
const int kBindWalkers = 33;      // uint a pixel of the list: its number
const int kBindWalkDispatch = 34; // WalkDispatch, of kStageWalks and of kStageWalksAcross
const int kShadeGroupSide = 8;   // pixels; the work group is square
// Of several methods that are decided together (shadow/decide_methods.comp.glsl).
const int kBindMethodParams = 35;  // BiasParams[kMostTogether]
const int kBindDecisions = 36;     // uint[planes][pixels]
const int kMostTogether = 8;

struct ShadeUniforms {
  CameraView camera;
  BiasParams bias;
  vec3 lightW;       // position, or for a directional light the unit direction towards it
  float positional;  // 1: lightW is a position, 0: a direction
  vec3 coneAxisW;    // unit, the way a spot light shines
  float coneCos;     // of its half angle; -1 where there is no cone
  vec3 lightColor;   // linear, times intensity times exposure
  vec3 ambient;      // linear
};

// The same in the light's frame, for the frame pass.
const int kBindFrame = 32;
struct FrameUniforms {
  EyeView eye;
  vec3 axisL;       // of the camera
  vec3 coneAxisL;
  vec3 towardsL;    // a directional light
};

// What decided a pixel: for labels, and for debugging.
struct PixelDiagnosis {
  uint texel;  // x | y << 14 | slice << 28
  uint flags;  // kPixel*
  uint walkEnds;   // of witness: WalkTally (bias/witness.glsl)
  uint walkSteps;
};
const uint kPixelShaded = 1u;     // a surface that faces the light
const uint kPixelCovered = 2u;    // the map covers it
const uint kPixelLit = 4u;
const uint kPixelGrazing = 8u;    // the texel's ray does not meet the receiver's plane between near and far
const uint kPixelUnknown = 16u;   // no such bias method
const uint kPixelWalks = 32u;     // left to kStageWalks
const uint kPixelWalksAcross = 64u;  // and to kStageWalksAcross
const float kUnknownVisibility = -1.0f;  // painted magenta

// The visibility pass of `witness`, unfiltered, goes in three dispatches: most pixels need no walk and are settled by
// the first, which lists the others for the rest, those that cross no edge from the front and those that do from the
// back. One pass for all has every group of pixels walk if one must, and lavapipe runs even a loop that no pixel enters
// once.
const int kStageWhole = 0;  // one dispatch for all
const int kStageLists = 1;
const int kStageWalks = 2;
const int kStageWalksAcross = 3;  // those that ask texels beyond their slice's edge: a third more for every pixel

// Arguments of a dispatch over a list, and how many it has to do; each is 1 when the first begins.
struct WalkDispatch {
  uint groupsX, groupsY, groupsZ;
  uint countPlusOne;
};
const uint kMostWalkGroupsX = 64u;  // a dispatch may have 65,535 groups a side: pictures of 16,384 x 16,384

GNOMON_FN uint packTexel(int slice, ivec2 texel) {
  return uint(texel.x) | (uint(texel.y) << 14u) | (uint(slice) << 28u);
}

GNOMON_FN ivec2 unpackTexel(uint word) { return ivec2(int(word & 16383u), int((word >> 14u) & 16383u)); }

GNOMON_FN int unpackSlice(uint word) { return int(word >> 28u); }

// Not unit: from a point of a surface towards the light.
GNOMON_FN vec3 towardsLight(ShadeUniforms shade, vec3 posW) { return shade.lightW - posW * shade.positional; }

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::ShadeUniforms) == 128 + sizeof(gnomon::glsl::BiasParams) + 16 + 16 + 24);
static_assert(offsetof(gnomon::glsl::ShadeUniforms, ambient) == sizeof(gnomon::glsl::ShadeUniforms) - 12);
#endif
#endif
