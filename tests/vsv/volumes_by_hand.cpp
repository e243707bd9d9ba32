#include "volumes_by_hand.h"

#include <cmath>
#include <limits>
#include <random>

namespace gnomon::test {

glsl::EpipolarGrid fullGrid(int alphaCount, int thetaCount, int phiCount) {
  return {.eyeDistance = 5.0f,
          .alphaLower = 0.1f,
          .alphaStep = 2.8f / static_cast<float>(alphaCount),
          .thetaLower = -glsl::kPi,
          .thetaStep = 2.0f * glsl::kPi / static_cast<float>(thetaCount),
          .phiLower = 0.0f,
          .phiStep = (glsl::kPi - 0.1f) / static_cast<float>(phiCount),
          .alphaCount = alphaCount,
          .thetaCount = thetaCount,
          .phiCount = phiCount};
}

glsl::LightFrame tiltedFrame() {
  const glm::dvec3 back = glm::normalize(glm::dvec3(2.0, 0.5, 1.0));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
  return {.originW = {1.0f, 2.0f, 3.0f},
          .rightW = glm::vec3(right),
          .upW = glm::vec3(glm::cross(back, right)),
          .backW = glm::vec3(back)};
}

std::vector<float> randomOccluders(const glsl::EpipolarGrid& grid, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> alpha(-0.1f, glsl::kPi);
  std::uniform_int_distribution<int> kind(0, 9);
  std::uniform_int_distribution<int> voxel(0, grid.alphaCount - 1);
  std::vector<float> occluders(columnCount(grid));
  for (float& occluder : occluders) {
    const int k = kind(random);
    occluder = k == 0   ? std::numeric_limits<float>::infinity()
               : k == 1 ? glsl::alphaCenter(grid, voxel(random))
                        : alpha(random);
  }
  return occluders;
}

std::vector<float> smoothOccluders(const glsl::EpipolarGrid& grid) {
  std::vector<float> occluders(columnCount(grid));
  for (int phi = 0; phi < grid.phiCount; ++phi)
    for (int theta = 0; theta < grid.thetaCount; ++theta)
      occluders[columnIndex(grid, theta, phi)] = 1.0f + 0.5f * std::sin(static_cast<float>(theta) * grid.thetaStep) +
                                                 0.3f * std::cos(static_cast<float>(phi) * grid.phiStep);
  return occluders;
}

}  // namespace gnomon::test
