// Percentage-closer filtering: a filter is a weighted set of taps. Each tap is a texel with its own ray; the bias is
// evaluated per tap, and the verdicts are averaged (Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth
// Maps", 1987).
//
//   none       the texel that holds the receiver
//   bilinear   the 2 x 2 texels whose centres surround it, weighted by the fractions: a tent, two texels wide
//   jitter4x4  16 points, one at random in each of 4 x 4 cells of a square around it, `width` texels wide
//              (4: Weiskopf & Ertl 2003, section 5)
//
// Filtered results are scored against the exact shadow filtered with the same kernels (kernelOffset).
//
// To add one: an id, the places of its knobs, a case in filterTap and in kernelOffset here; a row
// in src/shadow/filter.cpp.
#ifndef GNOMON_FILTER_GLSL
#define GNOMON_FILTER_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kShadowFilterNone = 0;
const int kShadowFilterBilinear = 1;
const int kShadowFilterJitter4x4 = 2;

const int kMostFilterKnobs = 2;

// The parameters of one filter, in the order of its row in src/shadow/filter.cpp.
struct FilterParams {
  float knobs[kMostFilterKnobs];
};
const int kJitterWidth = 0;  // texels

const int kKernelSamples = 16;  // of the exact kernels

struct FilterTap {
  ivec2 texel;  // may lie beyond the slice's edge
  vec2 at;      // the place it stands for, texels: a bias that is exact needs no texel
  float weight;
};

// "PCG" of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
GNOMON_FN uint hashOf(uint value) {
  uint state = value * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// One stream of random numbers a pixel, the same in every frame.
GNOMON_FN uint pixelSeed(ivec2 pixel) { return hashOf(uint(pixel.x) + hashOf(uint(pixel.y))); }

// A random point in cell i of a 4 x 4 grid over [0,1)^2.
GNOMON_FN vec2 stratifiedPoint(uint seed, int i) {
  uint h = hashOf(seed + uint(i));
  return vec2((float(i & 3) + float(h & 0xffffu) * (1.0f / 65536.0f)) * 0.25f,
              (float(i >> 2) + float(h >> 16u) * (1.0f / 65536.0f)) * 0.25f);
}

GNOMON_FN vec2 jitterOffset(FilterParams params, uint seed, int i) {
  float width = params.knobs[kJitterWidth];
  vec2 p = stratifiedPoint(seed, i);
  return vec2(p.x * width - 0.5f * width, p.y * width - 0.5f * width);
}

GNOMON_FN FilterTap tapAt(vec2 at, float weight) {
  FilterTap tap;
  tap.texel = ivec2(int(floor(at.x)), int(floor(at.y)));
  tap.at = at;
  tap.weight = weight;
  return tap;
}

GNOMON_FN FilterTap bilinearTap(vec2 position, int i) {
  vec2 first = vec2(floor(position.x - 0.5f), floor(position.y - 0.5f));
  vec2 fraction = vec2(position.x - 0.5f - first.x, position.y - 0.5f - first.y);
  float wx = (i & 1) == 1 ? fraction.x : 1.0f - fraction.x;
  float wy = (i >> 1) == 1 ? fraction.y : 1.0f - fraction.y;
  FilterTap tap = tapAt(first + vec2(float(i & 1), float(i >> 1)), wx * wy);
  tap.at = vec2(tap.at.x + 0.5f, tap.at.y + 0.5f);
  return tap;
}

// Tap i of a receiver that falls on `position` (texels of the slice). An unknown filter sets `known` to false, and the
// shader paints magenta.
GNOMON_FN FilterTap filterTap(int kind, FilterParams params, vec2 position, uint seed, int i,
                              GNOMON_OUT(bool) known) {
  known = true;
  switch (kind) {
    case kShadowFilterNone:
      return tapAt(position, 1.0f);
    case kShadowFilterBilinear:
      return bilinearTap(position, i);
    case kShadowFilterJitter4x4:
      return tapAt(position + jitterOffset(params, seed, i), 1.0f / 16.0f);
  }
  known = false;
  return tapAt(position, 1.0f);
}

// Inverse of a tent's distribution over [-1,1].
GNOMON_FN float tentPoint(float u) { return u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f * (1.0f - u)); }

// Where sample i of the exact kernel lies, in texels from the receiver; all weigh the same. The kernel itself, and
// not the texels' centres: what a finer map would converge to. As in filterTap, `known`.
GNOMON_FN vec2 kernelOffset(int kind, FilterParams params, uint seed, int i, GNOMON_OUT(bool) known) {
  known = true;
  switch (kind) {
    case kShadowFilterNone:
      return vec2(0.0f, 0.0f);
    case kShadowFilterBilinear: {
      vec2 p = stratifiedPoint(seed, i);
      return vec2(tentPoint(p.x), tentPoint(p.y));
    }
    case kShadowFilterJitter4x4:
      return jitterOffset(params, seed, i);
  }
  known = false;
  return vec2(0.0f, 0.0f);
}

GNOMON_SHARED_END
#endif
