// In-scattered light of a homogeneous medium, with visibility from the bits of a shadow volume. A view ray's bits are
// one row of texels, and a run of lit bits contributes the difference of the running integral at its ends.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"
#include "shared/volume.glsl"

layout(scalar, push_constant) uniform Push { MediaPush push; };

#include "vsv/view_ray.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(constant_id = 0) const int kIntegrator = kIntegrateRuns;

layout(scalar, binding = kBindBits) readonly buffer Bits { uvec4 bits[]; };
layout(binding = kBindRunning) uniform texture2D running;

// Of the view ray: where it lies in the table, and its ends in bins of phi.
int tableRow;
float tableBlend;
float columnOfFirstBin, columnsInBin;
float binBegin, binEnd;

void placeRay(EpipolarGrid grid, float alpha, PhiRange range) {
  float rowStep = float(grid.alphaCount) * grid.alphaStep / float(kTableRows - 1);
  float rows = clamp((alpha - grid.alphaLower) / rowStep, 0.0f, float(kTableRows - 1));
  tableRow = min(int(rows), kTableRows - 2);
  tableBlend = rows - float(tableRow);
  float columns = float(kTableColumns - 1) / max(phiOfLastColumn(phiUpper(grid), alpha), 1e-30f);
  columnOfFirstBin = grid.phiLower * columns;
  columnsInBin = grid.phiStep * columns;
  binBegin = (range.begin - grid.phiLower) / grid.phiStep;
  binEnd = min((range.end - grid.phiLower) / grid.phiStep, float(grid.phiCount));
}

// The running integral at a phi in bins.
vec3 runningAt(float bin) {
  float columns = clamp(columnOfFirstBin + bin * columnsInBin, 0.0f, float(kTableColumns - 1));
  int column = min(int(columns), kTableColumns - 2);
  float blend = columns - float(column);
  vec4 lower = mix(texelFetch(running, ivec2(column, tableRow), 0), texelFetch(running, ivec2(column + 1, tableRow), 0),
                   blend);
  vec4 upper = mix(texelFetch(running, ivec2(column, tableRow + 1), 0),
                   texelFetch(running, ivec2(column + 1, tableRow + 1), 0), blend);
  return vec3(mix(lower, upper, tableBlend));
}

// The lower border of a bin, and of the last its upper, but not beyond the ray's ends. What lies before the volume
// counts as its first bin does.
float borderOnRay(int bin, int firstBin) { return bin == firstBin ? binBegin : min(float(bin), binEnd); }

// Bits 0 .. n - 1 of a word.
uint lowBits(int n) { return n >= 32 ? 0xffffffffu : n <= 0 ? 0u : (1u << uint(n)) - 1u; }

// The four words of a block; bits that do not lie on the ray are taken for occluded.
uvec4 wordsOfBlock(EpipolarGrid grid, uint texel, int block, int firstBin, int lastBin) {
  uvec4 words = bits[texel + uint(min(block, grid.phiCount / kPhiBits - 1) * grid.alphaCount * kThetaBlock)];
  int begin = firstBin - block * kPhiBits;
  int end = lastBin + 1 - block * kPhiBits;
  return words | uvec4(lowBits(begin), lowBits(begin - 32), lowBits(begin - 64), lowBits(begin - 96)) |
         ~uvec4(lowBits(end), lowBits(end - 32), lowBits(end - 64), lowBits(end - 96));
}

// Where the lowest bit of the four words is, which is cleared.
int takeLowestBit(inout uvec4 words) {
  bool x = words.x != 0u;
  bool y = !x && words.y != 0u;
  bool z = !x && !y && words.z != 0u;
  uint word = x ? words.x : y ? words.y : z ? words.z : words.w;
  uint rest = word & (word - 1u);
  words = uvec4(x ? rest : words.x, y ? rest : words.y, z ? rest : words.z, x || y || z ? words.w : rest);
  return findLSB(word) + (x ? 0 : y ? 32 : z ? 64 : 96);
}

vec3 integrateLit(EpipolarGrid grid, uint texel) {
  int firstBin = clamp(int(binBegin), 0, grid.phiCount - 1);
  int lastBin = clamp(int(binEnd), firstBin, grid.phiCount - 1);
  vec3 sum = vec3(0.0f);
  float sign_ = -1.0f;       // of the next edge: the first is one into the light
  float litBins = 0.0f;
  uint before = 1u;          // the bit before the block's first
  // As far as the bit behind the last, so that the last edge is one into shadow.
  for (int block = firstBin / kPhiBits; block <= (lastBin + 1) / kPhiBits; ++block) {
    uvec4 words = wordsOfBlock(grid, texel, block, firstBin, lastBin);
    if (kIntegrator == kIntegrateRuns) {
      uvec4 edges = words ^ (words << 1u | uvec4(before, words.x >> 31u, words.y >> 31u, words.z >> 31u));
      before = words.w >> 31u;
      while (edges != uvec4(0u)) {
        int bin = block * kPhiBits + takeLowestBit(edges);
        sum += runningAt(borderOnRay(bin, firstBin)) * sign_;
        sign_ = -sign_;
      }
    } else if (kIntegrator == kIntegrateBits) {
      uvec4 lit = ~words;
      while (lit != uvec4(0u)) {
        int bin = block * kPhiBits + takeLowestBit(lit);
        sum += runningAt(min(float(bin + 1), binEnd)) - runningAt(borderOnRay(bin, firstBin));
      }
    } else {
      ivec4 counts = bitCount(~words);
      litBins += float(counts.x + counts.y + counts.z + counts.w);
    }
  }
  if (kIntegrator == kIntegratePopcount) {
    // A bin at an end counts as much as there is of it, and is as lit as the others.
    float share = litBins / float(lastBin - firstBin + 1);
    return (runningAt(binEnd) - runningAt(binBegin)) * share;
  }
  return max(sum, vec3(0.0f));  // differences round to either side of nothing
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  EpipolarGrid grid = shadowMap.epipolar;
  ViewRay ray = fetchViewRay(pixel);
  vec3 dirL = directionFromWorld(lightFrame, ray.dirW);
  float sinAlpha = sqrt(dirL.x * dirL.x + dirL.y * dirL.y);
  float alpha = atan2(sinAlpha, -dirL.z);
  int i = clamp(int(floor((alpha - grid.alphaLower) / grid.alphaStep)), 0, grid.alphaCount - 1);
  int k = clamp(int(thetaSteps(grid, atan2(dirL.x, dirL.y))), 0, grid.thetaCount - 1);
  vec2 outward = vec2(dirL.x, dirL.y) / max(sinAlpha, 1.2e-7f);
  PhiRange range = phiWithinCone(directionFromWorld(lightFrame, push.coneAxisW), push.coneCos, outward,
                                 phiOnViewRay(grid.eyeDistance, sinAlpha, -dirL.z, ray.end));
  placeRay(grid, alpha, range);
  vec3 light = vec3(0.0f);
  if (range.end > range.begin)
    light = integrateLit(grid, epipolarTexelIndex(grid, i, k, 0)) *
            scatteringFactor(media.medium, grid.eyeDistance, sinAlpha);
  scatter(pixel, light * push.intensity);
}
