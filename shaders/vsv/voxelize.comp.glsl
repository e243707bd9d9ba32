// Bits of a shadow volume of its columns' occluders: one invocation a column of texels, 128 columns of voxels, so that
// no two write one texel and no atomics are needed.
// kStep (kVoxelize*): seed and scan are passes of their own, or one.
#include "shared/map.glsl"
#include "shared/volume.glsl"

layout(local_size_x = kVoxelGroupSize) in;

layout(constant_id = 0) const int kStep = kVoxelizeFused;

layout(scalar, binding = kBindOccluders) readonly buffer Occluders { float occluders[]; };
layout(scalar, binding = kBindBits) buffer Bits { uvec4 texels[]; };

void main() {
  EpipolarGrid grid = shadowMap.epipolar;
  int k = int(gl_GlobalInvocationID.x);
  int block = int(gl_GlobalInvocationID.y);
  uint first = epipolarTexelIndex(grid, 0, k, block);
  uint stride = epipolarTexelIndex(grid, 1, 0, 0) - epipolarTexelIndex(grid, 0, 0, 0);
  // Columns of texels that only fill up the last eight hold nothing.
  int bitCount = k < grid.thetaCount ? kPhiBits : 0;
  int column = block * kPhiBits * grid.thetaCount + k;

  int lowest = grid.alphaCount;   // no bit is set before
  int settled = 0;                // and none of the first bits after
  if (kStep == kVoxelizeFused) {
    // The nearest and the farthest occluder that sets a bit, since a farther one sets none before.
    float last = alphaCenter(grid, grid.alphaCount - 1);
    float nearest = last;
    float farthest = grid.alphaLower - 1.0f;
    for (int j = 0; j < bitCount; ++j) {
      float alpha = occluders[column + j * grid.thetaCount];
      nearest = min(nearest, alpha);
      farthest = max(farthest, alpha < last ? alpha : farthest);
    }
    lowest = firstOccluded(grid, nearest);
    if (nearest < last) settled = firstOccluded(grid, farthest) + 1;
    uint end = first + uint(settled) * stride;
    for (uint at = first; at != end; at += stride) texels[at] = uvec4(0u);
  }
  if (kStep != kVoxelizeScan) {
    for (int j = 0; j < bitCount; ++j) {
      int i = firstOccluded(grid, occluders[column + j * grid.thetaCount]);
      if (i < grid.alphaCount) texels[first + uint(i) * stride][j >> 5] |= 1u << uint(j & 31);
    }
  }
  if (kStep == kVoxelizeScan) {
    lowest = 0;
    settled = grid.alphaCount;
  }
  if (kStep != kVoxelizeSeed) {
    uvec4 occluded = uvec4(0u);
    uint at = first + uint(min(lowest, settled)) * stride;
    for (int i = lowest; i < settled; ++i, at += stride) {
      occluded |= texels[at];
      texels[at] = occluded;
    }
    at = first + uint(settled) * stride;
    for (int i = settled; i < grid.alphaCount; ++i, at += stride) texels[at] = occluded;
  }
}
