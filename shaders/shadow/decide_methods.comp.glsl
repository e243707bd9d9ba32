// What several biases of shared/bias.glsl say of the unfiltered map, in one dispatch: they share the pixel's receiver,
// its texel, the texel's ray and what it holds. Those that move the receiver first share the receiver that they move.
// All read the same channels. Each method is a specialization constant, as the one of shade_visibility.comp.glsl is,
// and says what it says there, bit for bit.
//
// Of each pixel a byte of PixelDiagnosis::flags a method, four to a word, then the texel that they share, then one of
// each method that moves the receiver: planes of one word a pixel (src/shadow/decision_pass.h).
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind

#include "shared/filter.glsl"
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 13) const int kMethodCount = 1;
layout(constant_id = 14) const int kMethod0 = 0;  // kBias*
layout(constant_id = 15) const int kMethod1 = 0;
layout(constant_id = 16) const int kMethod2 = 0;
layout(constant_id = 17) const int kMethod3 = 0;
layout(constant_id = 18) const int kMethod4 = 0;
layout(constant_id = 19) const int kMethod5 = 0;
layout(constant_id = 20) const int kMethod6 = 0;
layout(constant_id = 21) const int kMethod7 = 0;

layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindMethodParams) uniform MethodParams { BiasParams methodParams[kMostTogether]; };
layout(scalar, binding = kBindDecisions) writeonly buffer Decisions { uint decisions[]; };

#include "shadow/fetch_tap.glsl"
#include "shadow/receiver_fetch.glsl"
#include "shadow/receiver_id.glsl"
#include "shadow/specialized_map.glsl"

// A receiver where it is looked up: its texel, and flags that all methods that ask there have in common.
struct Asked {
  Receiver receiver;
  bool covered;
  Tap tap;
  uint flags;
};

Asked ask(ShadowMap map, Receiver receiver) {
  Asked asked;
  asked.receiver = receiver;
  asked.flags = kPixelShaded;
  MapPoint point = mapProject(map, receiver.posL);
  asked.covered = point.covered;
  if (!point.covered) return asked;
  asked.tap = fetchTap(map, point.slice, mapTexel(map, point.uv));
  asked.flags |= kPixelCovered;
  if (receiverPlaneDepth(map, asked.tap.slice, receiver, asked.tap.ray).grazing) asked.flags |= kPixelGrazing;
  return asked;
}

uint texelWord(Asked asked) { return asked.covered ? packTexel(asked.tap.slice, asked.tap.texel) : 0u; }

void write(int plane, uint index, uint word) {
  decisions[uint(plane) * uint(shade.camera.width * shade.camera.height) + index] = word;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PrimitiveId id = fetchPrimitive(pixel);
  Receiver receiver;
  bool shaded = id.instancePlusOne != 0u && fetchReceiver(pixel, id, receiver);
  uint flags[2] = uint[2](0u, 0u);
  int plane = (kMethodCount + 3) / 4;
  if (!shaded) {
    for (int i = 0; i < plane; ++i) write(i, index, 0u);
    return;
  }
  receiver.id = receiverId(id);
  ShadowMap map = specializedMap();
  Asked own = ask(map, receiver);
  write(plane, index, texelWord(own));
  // Of the constant METHOD: a call in place of a function of it, which would be compiled with all methods in it.
#define MOVED(id, value) \
  if (METHOD == id) receiver = value;
#define LIT(id, value)                                   \
  if (METHOD == id) {                                    \
    known = true;                                        \
    lit = lit || value;                                  \
  }
#define DECIDE(i)                                                                                 \
  if (i < kMethodCount) {                                                                         \
    BiasParams params = methodParams[i];                                                          \
    Asked asked = own;                                                                            \
    if (MOVES) {                                                                                  \
      Receiver receiver = own.receiver;                                                           \
      GNOMON_MOVING_BIASES(MOVED)                                                                 \
      asked = ask(map, receiver);                                                                 \
      write(++plane, index, texelWord(asked));                                                    \
    }                                                                                             \
    uint bits = asked.flags;                                                                      \
    if (asked.covered) {                                                                          \
      Receiver receiver = asked.receiver;                                                         \
      Tap tap = asked.tap;                                                                        \
      bool known = false;                                                                         \
      bool lit = holdsNothing(tap);                                                               \
      GNOMON_BIASES(LIT)                                                                          \
      bits |= (lit ? kPixelLit : 0u) | (known ? 0u : kPixelUnknown);                              \
    }                                                                                             \
    flags[i / 4] |= bits << (8 * (i % 4));                                                        \
  }
#define MOVES_CASE(id, value) || METHOD == id
#define MOVES (false GNOMON_MOVING_BIASES(MOVES_CASE))
#define METHOD kMethod0
  DECIDE(0)
#undef METHOD
#define METHOD kMethod1
  DECIDE(1)
#undef METHOD
#define METHOD kMethod2
  DECIDE(2)
#undef METHOD
#define METHOD kMethod3
  DECIDE(3)
#undef METHOD
#define METHOD kMethod4
  DECIDE(4)
#undef METHOD
#define METHOD kMethod5
  DECIDE(5)
#undef METHOD
#define METHOD kMethod6
  DECIDE(6)
#undef METHOD
#define METHOD kMethod7
  DECIDE(7)
  for (int i = 0; i < (kMethodCount + 3) / 4; ++i) write(i, index, flags[i]);
}
