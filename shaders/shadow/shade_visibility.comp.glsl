// One visibility shader for every map, bias and filter: G-buffer pixel -> receiver -> taps -> how much of them is lit.
//
// The method, the map's kind and its slice count are specialization constants, so that each pipeline holds one bias on
// one map only, and reads the matrices of a single layer from constant addresses. kDiagnose also writes what decided
// the pixel, of one tap; timings are taken without it.
layout(constant_id = 0) const int kMethod = 0;   // kBias*
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_BIAS_METHOD kMethod
#define GNOMON_MAP_KIND kMapKind

#include "shared/filter.glsl"
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"
#include "shadow/store_visibility.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 1) const int kDiagnose = 0;
layout(constant_id = 9) const int kMaskedScene = 1;
layout(constant_id = 10) const int kStage = kStageWhole;  // kStage*
layout(constant_id = 11) const int kWitnessReach = 2;  // of shade.bias: lavapipe runs a loop over 0 texels once

layout(push_constant, scalar) uniform Push {
  FilterParams filterParams;
  float endMargin;  // LookupTables
  uint idShift;
};
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindDiagnosis) writeonly buffer Diagnosis { PixelDiagnosis diagnosis[]; };

layout(scalar, binding = kBindWalkers) buffer Walkers { uint walkers[]; };
layout(scalar, binding = kBindWalkDispatch) buffer Dispatches { WalkDispatch walkDispatches[2]; };

#include "shadow/surface_visibility.glsl"

#include "shadow/map_visibility.glsl"
#include "shadow/receiver_fetch.glsl"
#include "shadow/receiver_id.glsl"
#include "shadow/specialized_map.glsl"

// Empty pixels are lit; a surface that faces away is not.
float shadePixel(ivec2 pixel, PrimitiveId id, inout PixelDiagnosis pixelDiagnosis) {
  if (id.instancePlusOne == 0u) return 1.0f;
  Receiver receiver;
  if (!fetchReceiver(pixel, id, receiver)) return 0.0f;
  receiver.id = receiverId(id);
  return receiverVisibility(specializedMap(), receiver, pixel, pixelDiagnosis);
}

int walkerPlace(int list, uint place) {
  return list == 0 ? int(place) : shade.camera.width * shade.camera.height - 1 - int(place);
}

// Appends a pixel to the list of kStageWalks, 0, or of kStageWalksAcross, 1. What begins a group adds the group.
void listWalker(uint index, int list) {
  uint place = atomicAdd(walkDispatches[list].countPlusOne, 1u) - 1u;
  walkers[walkerPlace(list, place)] = index;
  uint group = place / uint(kShadeGroupSide * kShadeGroupSide);
  bool begins = group * uint(kShadeGroupSide * kShadeGroupSide) == place;
  if (begins && group > 0u && group < kMostWalkGroupsX) atomicAdd(walkDispatches[list].groupsX, 1u);
  if (begins && group >= kMostWalkGroupsX && group % kMostWalkGroupsX == 0u)
    atomicAdd(walkDispatches[list].groupsY, 1u);
}

// Which pixel this invocation shades; false: none.
bool ownPixel(out ivec2 pixel) {
  int width = shade.camera.width;
  if (kStage == kStageWalks || kStage == kStageWalksAcross) {
    int list = kStage == kStageWalks ? 0 : 1;
    uint group = gl_WorkGroupID.y * kMostWalkGroupsX + gl_WorkGroupID.x;
    uint place = group * uint(kShadeGroupSide * kShadeGroupSide) + gl_LocalInvocationIndex;
    bool listed = place + 1u < walkDispatches[list].countPlusOne;
    int index = listed ? int(walkers[walkerPlace(list, place)]) : 0;
    pixel = ivec2(index % width, index / width);
    return listed;
  }
  pixel = ivec2(gl_GlobalInvocationID.xy);
  return pixel.x < width && pixel.y < shade.camera.height;
}

void main() {
  ivec2 pixel;
  if (!ownPixel(pixel)) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PixelDiagnosis pixelDiagnosis;
  pixelDiagnosis.texel = 0u;
  pixelDiagnosis.flags = 0u;
  pixelDiagnosis.walkEnds = 0u;
  pixelDiagnosis.walkSteps = 0u;
  storeVisibility(pixel, shade.camera.width, shadePixel(pixel, fetchPrimitive(pixel), pixelDiagnosis));
  if (kDiagnose == 1) diagnosis[index] = pixelDiagnosis;
  uint walks = pixelDiagnosis.flags & (kPixelWalks | kPixelWalksAcross);
  if (kStage == kStageLists && walks != 0u) listWalker(index, walks == kPixelWalks ? 0 : 1);
}
