// What the integrators of bits share. All of a view ray's bits lie in one row of texels, and what a stretch of it
// weighs is the difference of the running integral at its ends. A shader that includes this defines integrateLit.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"
#include "shared/volume.glsl"

layout(scalar, push_constant) uniform Push { MediaPush push; };

#include "vsv/view_ray.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(scalar, binding = kBindBits) readonly buffer Bits { uvec4 bits[]; };
layout(binding = kBindRunning) uniform texture2D running;

// The bits of the view ray at hand, in bins of phi.
struct BitsOnRay {
  EpipolarGrid grid;
  uint texel;  // of the first block
  int firstBin, lastBin;
};

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
  vec4 lower = mix(texelFetch(running, ivec2(column, tableRow), 0),
                   texelFetch(running, ivec2(column + 1, tableRow), 0), blend);
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
uvec4 wordsOfBlock(BitsOnRay ray, int block) {
  int stored = min(block, ray.grid.phiCount / kPhiBits - 1);
  uvec4 words = bits[ray.texel + uint(stored * ray.grid.alphaCount * kThetaBlock)];
  int begin = ray.firstBin - block * kPhiBits;
  int end = ray.lastBin + 1 - block * kPhiBits;
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

// The integral over what of the ray is lit, per candela and before the scattering factor.
vec3 integrateLit(BitsOnRay ray);

BitsOnRay bitsOnRay(EpipolarGrid grid, uint texel) {
  int firstBin = clamp(int(binBegin), 0, grid.phiCount - 1);
  int lastBin = clamp(int(binEnd), firstBin, grid.phiCount - 1);
  return BitsOnRay(grid, texel, firstBin, lastBin);
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
    light = integrateLit(bitsOnRay(grid, epipolarTexelIndex(grid, i, k, 0))) *
            scatteringFactor(media.medium, grid.eyeDistance, sinAlpha);
  scatter(pixel, light * push.intensity);
}
