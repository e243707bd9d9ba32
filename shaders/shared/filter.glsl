// A filter is a weighted set of taps: each is a texel with its own ray, decided on its own, and the verdicts are averaged
// (percentage closer filtering: Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth Maps", 1987).
//
//   none       the texel that holds the receiver
//   bilinear   the 2 x 2 texels whose centres surround it, weighted by the fractions: a tent, two texels wide
//   jitter4x4  16 points, one at random in each cell of a square four texels wide around it (Weiskopf & Ertl 2003, section 5)
//
// The same kernels over the exact shadow are what filtered results are scored against: kernelOffset.
#ifndef GNOMON_FILTER_GLSL
#define GNOMON_FILTER_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kFilterNone = 0;
const int kFilterBilinear = 1;
const int kFilterJitter4x4 = 2;

const int kKernelSamples = 16;  // of the exact kernels

struct FilterTap {
  ivec2 texel;  // may lie beyond the layer's edge
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

GNOMON_FN vec2 jitterOffset(uint seed, int i) {
  vec2 p = stratifiedPoint(seed, i);
  return vec2(p.x * 4.0f - 2.0f, p.y * 4.0f - 2.0f);
}

GNOMON_FN int filterTapCount(int kind) { return kind == kFilterJitter4x4 ? 16 : kind == kFilterBilinear ? 4 : 1; }

// Tap i of a receiver that falls on `position` (texels of the layer).
GNOMON_FN FilterTap filterTap(int kind, vec2 position, uint seed, int i) {
  FilterTap tap;
  tap.weight = 1.0f;
  vec2 at = position;
  if (kind == kFilterJitter4x4) {
    at = position + jitterOffset(seed, i);
    tap.weight = 1.0f / 16.0f;
  }
  if (kind == kFilterBilinear) {
    vec2 first = vec2(floor(position.x - 0.5f), floor(position.y - 0.5f));
    vec2 fraction = vec2(position.x - 0.5f - first.x, position.y - 0.5f - first.y);
    float wx = (i & 1) == 1 ? fraction.x : 1.0f - fraction.x;
    float wy = (i >> 1) == 1 ? fraction.y : 1.0f - fraction.y;
    tap.weight = wx * wy;
    at = first + vec2(float(i & 1), float(i >> 1));
  }
  tap.texel = ivec2(int(floor(at.x)), int(floor(at.y)));
  return tap;
}

// Inverse of a tent's distribution over [-1,1].
GNOMON_FN float tentPoint(float u) { return u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f * (1.0f - u)); }

// Where sample i of the exact kernel lies, in texels from the receiver; all weigh the same. The kernel itself, and
// not the texels' centres: what a finer map would converge to.
GNOMON_FN vec2 kernelOffset(int kind, uint seed, int i) {
  if (kind == kFilterJitter4x4) return jitterOffset(seed, i);
  if (kind == kFilterBilinear) {
    vec2 p = stratifiedPoint(seed, i);
    return vec2(tentPoint(p.x), tentPoint(p.y));
  }
  return vec2(0.0f, 0.0f);
}

GNOMON_SHARED_END
#endif
