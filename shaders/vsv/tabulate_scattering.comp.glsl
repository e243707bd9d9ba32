// The running integral of a homogeneous medium's scattering over phi (shared/medium.glsl), without what light and view
// ray give as factors. One invocation a row: a sum in order, the same at every run.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"

layout(local_size_x = kTableGroupSize) in;

layout(scalar, binding = kBindMedia) uniform Media { MediaUniforms media; };
layout(rgba32f, binding = kBindRunning) uniform writeonly image2D running;

void main() {
  int row = int(gl_GlobalInvocationID.x);
  if (row >= kTableRows) return;
  EpipolarGrid grid = shadowMap.epipolar;
  float alpha = grid.alphaLower + float(row) * (float(grid.alphaCount) * grid.alphaStep / float(kTableRows - 1));
  float phiStep = phiOfLastColumn(phiUpper(grid), alpha) / float(kTableColumns - 1);
  vec3 sum = vec3(0.0f);
  for (int column = 0; column < kTableColumns; ++column) {
    imageStore(running, ivec2(column, row), vec4(sum, 0.0f));
    float phi = float(column) * phiStep;
    sum += scatteringBetween(media.medium, grid.eyeDistance, alpha, phi, phi + phiStep);
  }
}
