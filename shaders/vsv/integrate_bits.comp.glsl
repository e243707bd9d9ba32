// Light scattered towards the eye by a homogeneous medium, with visibility from the bits of a shadow volume: all of a view ray's bits lie in
// one row of texels, and what a bit weighs is the difference of the running integral at its borders.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"
#include "shared/volume.glsl"

#include "vsv/view_ray.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(constant_id = 0) const int kIntegrator = kIntegrateRuns;

layout(scalar, binding = kBindBits) readonly buffer Bits { uvec4 bits[]; };
layout(scalar, binding = kBindRunning) readonly buffer Running { vec3 running[]; };

// The rows of the table that the view ray lies between.
int tableRow;
float tableBlend;

vec3 runningAt(int border) {
  int at = border * kTableRows + tableRow;
  return mix(running[at], running[at + 1], tableBlend);
}

void chooseRows(EpipolarGrid grid, float alpha) {
  float rowStep = float(grid.alphaCount) * grid.alphaStep / float(kTableRows - 1);
  float rows = clamp((alpha - grid.alphaLower) / rowStep, 0.0f, float(kTableRows - 1));
  tableRow = min(int(rows), kTableRows - 2);
  tableBlend = rows - float(tableRow);
}

// An end of the view ray, among the bins of phi. Before the first and behind the last bin there is no more than their outer border.
struct PhiPlace {
  int bin;
  float within;  // 0 at the bin's lower border, 1 at its upper
};

PhiPlace placeAt(EpipolarGrid grid, float phi) {
  float steps = clamp((phi - grid.phiLower) / grid.phiStep, 0.0f, float(grid.phiCount));
  PhiPlace place;
  place.bin = min(int(steps), grid.phiCount - 1);
  place.within = steps - float(place.bin);
  return place;
}

// Bits 0 .. n - 1 of a word.
uint lowBits(int n) { return n >= 32 ? 0xffffffffu : n <= 0 ? 0u : (1u << uint(n)) - 1u; }

// What the bits of a stretch of the view ray say; those outside of it are taken for occluded.
struct LitBits {
  vec3 sum;   // of the running integral over the lit bins, the first and last of them whole
  int count;  // of lit bins
  bool firstLit, lastLit;
};

LitBits integrateBits(EpipolarGrid grid, uint texel, int firstBin, int lastBin) {
  uint texelsInBlock = uint(grid.alphaCount * kThetaBlock);
  LitBits lit;
  lit.sum = vec3(0.0f);
  lit.count = 0;
  uint before = 1u;  // the bit before a word's first
  for (int block = firstBin / kPhiBits; block <= lastBin / kPhiBits; ++block) {
    uvec4 words = bits[texel + uint(block) * texelsInBlock];
    for (int low = block * kPhiBits; low < (block + 1) * kPhiBits; low += 32) {
      uint word = words.x | lowBits(firstBin - low) | ~lowBits(lastBin + 1 - low);
      words = uvec4(words.y, words.z, words.w, 0u);
      if (firstBin >> 5 == low >> 5) lit.firstLit = (word >> uint(firstBin & 31) & 1u) == 0u;
      if (lastBin >> 5 == low >> 5) lit.lastLit = (word >> uint(lastBin & 31) & 1u) == 0u;
      if (kIntegrator == kIntegrateRuns) {
        uint edges = word ^ (word << 1u | before);  // where the ray comes from shadow to light or from light to shadow
        before = word >> 31u;
        while (edges != 0u) {
          int bit = findLSB(edges);
          vec3 value = runningAt(low + bit);
          lit.sum += (word >> uint(bit) & 1u) != 0u ? value : -value;
          edges &= edges - 1u;
        }
      } else if (kIntegrator == kIntegrateBits) {
        uint rest = ~word;
        while (rest != 0u) {
          int bit = findLSB(rest);
          lit.sum += runningAt(low + bit + 1) - runningAt(low + bit);
          rest &= rest - 1u;
        }
      } else {
        lit.count += bitCount(~word);
      }
    }
  }
  // A run that reaches the end of the last texel ends there.
  if (kIntegrator == kIntegrateRuns && before == 0u) lit.sum += runningAt(lastBin + 1);
  return lit;
}

// The integral over the lit part of the range. Within a bin the running integral is taken for linear.
vec3 integrateLit(EpipolarGrid grid, uint texel, PhiRange range) {
  PhiPlace first = placeAt(grid, range.begin);
  PhiPlace last = placeAt(grid, range.end);
  LitBits lit = integrateBits(grid, texel, first.bin, last.bin);

  vec3 lastUpper = runningAt(last.bin + 1);
  vec3 lastLower = runningAt(last.bin);
  vec3 end = mix(lastLower, lastUpper, last.within);
  vec3 firstLower = vec3(0.0f);
  vec3 begin = vec3(0.0f);
  if (range.begin > 0.0f) {
    firstLower = runningAt(first.bin);
    begin = mix(firstLower, runningAt(first.bin + 1), first.within);
  } else if (grid.phiLower > 0.0f) {
    firstLower = runningAt(0);  // what lies before the volume counts as its first bin does
  }

  if (kIntegrator == kIntegratePopcount) {
    float length = float(last.bin - first.bin) + last.within - first.within;
    float litLength = float(lit.count) - (lit.firstLit ? first.within : 0.0f) - (lit.lastLit ? 1.0f - last.within : 0.0f);
    return (end - begin) * (length > 0.0f ? clamp(litLength / length, 0.0f, 1.0f) : 0.0f);
  }
  if (lit.firstLit) lit.sum -= begin - firstLower;
  if (lit.lastLit) lit.sum -= lastUpper - end;
  return max(lit.sum, vec3(0.0f));  // a difference of sums rounds to either side of nothing
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  EpipolarGrid grid = shadowMap.epipolar;
  ViewRay ray = fetchViewRay(pixel);
  vec3 dirL = directionFromWorld(lightFrame, ray.dirW);
  float sinAlpha = sqrt(dirL.x * dirL.x + dirL.y * dirL.y);
  float alpha = atan2(sinAlpha, -dirL.z);
  chooseRows(grid, alpha);
  int i = clamp(int(floor((alpha - grid.alphaLower) / grid.alphaStep)), 0, grid.alphaCount - 1);
  int k = clamp(int(thetaSteps(grid, atan2(dirL.x, dirL.y))), 0, grid.thetaCount - 1);
  vec2 outward = vec2(dirL.x, dirL.y) / max(sinAlpha, 1.2e-7f);
  PhiRange range = phiWithinCone(directionFromWorld(lightFrame, push.coneAxisW), push.coneCos, outward,
                                 phiOnViewRay(grid.eyeDistance, sinAlpha, -dirL.z, ray.end));
  vec3 light = vec3(0.0f);
  if (range.end > range.begin)
    light = integrateLit(grid, epipolarTexelIndex(grid, i, k, 0), range) * scatteringFactor(media.medium, grid.eyeDistance, sinAlpha);
  scatter(pixel, light * push.intensity);
}
