// The running integral of a homogeneous medium's scattering over phi, without what light and view ray give as factors: a row for an alpha,
// a value for each border of a phi bin of the volume. One invocation a row: a sum in order, the same at every run.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"

layout(local_size_x = kTableGroupSize) in;

layout(scalar, binding = kBindMedia) uniform Media { MediaUniforms media; };
layout(scalar, binding = kBindRunning) writeonly buffer Running { vec3 running[]; };

void main() {
  int row = int(gl_GlobalInvocationID.x);
  if (row >= kTableRows) return;
  EpipolarGrid grid = shadowMap.epipolar;
  float alpha = grid.alphaLower + float(row) * (float(grid.alphaCount) * grid.alphaStep / float(kTableRows - 1));
  vec3 sum = scatteringBetween(media.medium, grid.eyeDistance, alpha, 0.0f, grid.phiLower);
  for (int j = 0; j < grid.phiCount; ++j) {
    running[j * kTableRows + row] = sum;
    float phi = grid.phiLower + float(j) * grid.phiStep;
    sum += scatteringBetween(media.medium, grid.eyeDistance, alpha, phi, phi + grid.phiStep);
  }
  running[grid.phiCount * kTableRows + row] = sum;
}
