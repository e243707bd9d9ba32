#include "base/error.h"
#include "omni/caster_range.h"
#include "vsv/shadow_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr double kPi = std::numbers::pi;

// Light and eye may not be nearer to each other than this share of the scene's diagonal: both are 32-bit
// positions, good to 2^-24 of it, so that a shorter axis is off by more than half a percent.
constexpr double kLeastAxis = 1e-5;
// A light just outside of the picture counts as in it: what passes that near to the axis has any theta.
constexpr double kPictureSlack = 1e-3;
// Voxels kept before what the camera sees: the adaptive look-up goes one back from there, and F' lies off P.
constexpr double kAlphaSlackVoxels = 2.0;

struct Range {
  double lower = 0.0, upper = 0.0;  // radians
};

// What the camera sees in the epipolar frame: unit directions of the picture's corners, in order round it.
struct Picture {
  std::array<glm::dvec3, 4> corners;
  bool seesLight = false;     // the epipole is on screen
  bool seesAntipode = false;  // what lies straight away from the light
};

double thetaOf(const glm::dvec3& dirL) {
  return std::atan2(dirL.x, dirL.y);
}

double alphaOf(const glm::dvec3& dirL) {
  return std::atan2(std::hypot(dirL.x, dirL.y), -dirL.z);
}

glm::dmat3 epipolarAxes(const glsl::CameraView& camera, const glm::dvec3& axisW) {
  const auto across = [&](const glm::vec3& dirW) {
    return glm::dvec3(dirW) - axisW * glm::dot(axisW, glm::dvec3(dirW));
  };
  // Where the axis is the camera's up, the way it looks stands in.
  glm::dvec3 upW = across(camera.upW);
  if (glm::length(upW) < 1e-3) upW = across(camera.forwardW);
  upW = glm::normalize(upW);
  return {glm::cross(upW, axisW), upW, axisW};
}

Picture pictureOf(const glsl::CameraView& camera, const glm::dmat3& worldFromLight) {
  const glm::dvec3 right(camera.rightW), up(camera.upW), forward(camera.forwardW);
  Picture picture;
  for (size_t i = 0; i < 4; ++i) {
    const double sx = i == 1 || i == 2 ? 1.0 : -1.0, sy = i >= 2 ? 1.0 : -1.0;
    picture.corners[i] =
        glm::normalize((forward + right * (sx * camera.tanHalfX) + up * (sy * camera.tanHalfY)) * worldFromLight);
  }
  const auto sees = [&](const glm::dvec3& dirW) {
    const double ahead = glm::dot(dirW, forward) * (1.0 + kPictureSlack);
    return ahead > 0.0 && std::abs(glm::dot(dirW, right)) <= ahead * camera.tanHalfX &&
           std::abs(glm::dot(dirW, up)) <= ahead * camera.tanHalfY;
  };
  picture.seesLight = sees(-worldFromLight[2]);
  picture.seesAntipode = sees(worldFromLight[2]);
  return picture;
}

// Of the picture: extreme on its border, at corners or where an edge, a great circle, passes the axis nearest
// or farthest; or inside it, at the axis itself.
Range alphaRange(const Picture& picture) {
  Range range{.lower = kPi, .upper = 0.0};
  const auto include = [&](const glm::dvec3& dirL) {
    range.lower = std::min(range.lower, alphaOf(dirL));
    range.upper = std::max(range.upper, alphaOf(dirL));
  };
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 p = picture.corners[i], q = picture.corners[(i + 1) % 4];
    include(p);
    const glm::dvec3 normal = glm::normalize(glm::cross(p, q));
    for (const double side : {1.0, -1.0}) {
      const glm::dvec3 extreme = side * (glm::dvec3(0, 0, 1) - normal * normal.z);
      if (glm::dot(glm::cross(p, extreme), normal) > 0.0 && glm::dot(glm::cross(extreme, q), normal) > 0.0)
        include(extreme);
    }
  }
  if (picture.seesLight) range.lower = 0.0;
  if (picture.seesAntipode) range.upper = kPi;
  return range;
}

// Theta runs one way along each edge, and a picture that does not see the axis spans less than half a turn:
// all of it lies between two corners, opposite the largest gap.
Range thetaRange(const Picture& picture) {
  if (picture.seesLight || picture.seesAntipode) return {.lower = -kPi, .upper = kPi};
  std::array<double, 4> thetas;
  std::ranges::transform(picture.corners, thetas.begin(), thetaOf);
  std::ranges::sort(thetas);
  size_t afterGap = 0;
  double gap = thetas[0] + 2.0 * kPi - thetas[3];
  for (size_t i = 1; i < 4; ++i) {
    if (thetas[i] - thetas[i - 1] <= gap) continue;
    gap = thetas[i] - thetas[i - 1];
    afterGap = i;
  }
  return {.lower = thetas[afterGap], .upper = thetas[afterGap] + 2.0 * kPi - gap};
}

// To the largest of the surfaces; without any to where the nearest view rays to the light end, at infinity.
double phiUpper(std::span<const glm::dvec3> receiversW, const glm::dvec3& lightW, const glm::dvec3& axisW,
                double alphaLower) {
  if (receiversW.empty()) return kPi - alphaLower;
  double least = 1.0;
  for (const glm::dvec3& receiver : receiversW) {
    const glm::dvec3 d = receiver - lightW;
    least = std::min(least, glm::dot(d, axisW) / glm::length(d));
  }
  return std::acos(std::clamp(least, -1.0, 1.0));
}

// `count` steps over the range, so that `below` and `above` steps of them lie outside.
void setSteps(const Range& range, int count, double below, double above, float& lower, float& step) {
  const double each = (range.upper - range.lower) / (count - below - above);
  step = static_cast<float>(each);
  lower = static_cast<float>(range.lower - below * each);
}

glsl::EpipolarGrid fullGrid(const VolumeSize& size) {
  glsl::EpipolarGrid grid{
      .thetaLower = -static_cast<float>(kPi), .alphaCount = size.alpha, .thetaCount = size.theta, .phiCount = size.phi};
  grid.alphaStep = static_cast<float>(kPi / size.alpha);
  grid.thetaStep = static_cast<float>(2.0 * kPi / size.theta);
  grid.phiStep = static_cast<float>(kPi / size.phi);
  return grid;
}

void fitToPicture(const glm::dvec3& lightW, const glsl::CameraView& camera, std::span<const glm::dvec3> receiversW,
                  const glm::dmat3& worldFromLight, glsl::EpipolarGrid& grid) {
  const Picture picture = pictureOf(camera, worldFromLight);
  const Range alpha = alphaRange(picture);
  const double alphaMargin = kAlphaSlackVoxels + 1.0;
  if (grid.alphaCount > 2.0 * alphaMargin) {
    setSteps(alpha, grid.alphaCount, kAlphaSlackVoxels, 1.0, grid.alphaLower, grid.alphaStep);
    if (grid.alphaLower < 0.0f) {  // nothing lies before the light
      grid.alphaLower = 0.0f;
      grid.alphaStep = static_cast<float>(std::min(alpha.upper * (1.0 + 1.0 / grid.alphaCount), kPi) / grid.alphaCount);
    }
  }
  // Half a column outside on each side, which a column's centre never needs.
  const Range theta = thetaRange(picture);
  const double turn = theta.upper - theta.lower;
  if (turn * (1.0 + 1.0 / grid.thetaCount) < 2.0 * kPi && grid.thetaCount > 2)
    setSteps(theta, grid.thetaCount, 0.5, 0.5, grid.thetaLower, grid.thetaStep);
  const double phi = phiUpper(receiversW, lightW, worldFromLight[2], alpha.lower);
  grid.phiStep = static_cast<float>(std::min(phi * (1.0 + 1.0 / grid.phiCount), kPi) / grid.phiCount);
}

FittedMap columnsFor(const glm::dvec3& lightW, const glsl::CameraView& camera, std::span<const glm::dvec3> receiversW,
                     float sceneScale, const VolumeSize& size, VolumeFit fit) {
  const glm::dvec3 eyeW(camera.eyeW);
  const double distance = glm::length(eyeW - lightW);
  if (!(distance > kLeastAxis * static_cast<double>(sceneScale)))
    throw WorldError(
        fmt::format("the light is {:g} m from the camera's eye, too near for a shadow volume's epipolar axis; move one "
                    "of them with --light or --camera, or use another map",
                    distance));
  const glm::dmat3 worldFromLight = epipolarAxes(camera, (eyeW - lightW) / distance);

  glsl::EpipolarGrid grid = fullGrid(size);
  if (fit != VolumeFit::Full) fitToPicture(lightW, camera, receiversW, worldFromLight, grid);
  grid.eyeDistance = static_cast<float>(distance);

  FittedMap columns;
  columns.frame = {.originW = glm::vec3(lightW),
                   .rightW = glm::vec3(worldFromLight[0]),
                   .upW = glm::vec3(worldFromLight[1]),
                   .backW = glm::vec3(worldFromLight[2])};
  columns.map = {.kind = glsl::kMapEpipolar,
                 .sliceCount = 1,
                 .width = size.theta,
                 .height = size.phi,
                 .sceneScale = sceneScale,
                 .epipolar = grid};
  SliceShaders& shaders = columns.shaders;
  shaders.projective = false;
  shaders.vertex = "shadow/pull_bounded_triangle.vert.glsl";
  shaders.fragment = "vsv/draw_in_epipolar.frag.glsl";
  shaders.rasterizedDepth = false;
  shaders.bounds = "vsv/bound_in_epipolar.comp.glsl";
  return columns;
}

}  // namespace

FittedMap fitVolume(const FitInput& input, const VolumeSize& size, VolumeFit fit) {
  const glm::dvec3& lightW = input.light.positionW;
  const std::span<const glm::dvec3> seenW = fit == VolumeFit::View ? std::span<const glm::dvec3>() : input.receiversW;
  FittedMap columns = columnsFor(lightW, input.camera, seenW, computeBounds(input.scene).diagonal(), size, fit);
  columns.zFar = static_cast<float>(farthestReceiver(input.scene, lightW, Distance::Radial, input.receiversW));
  return columns;
}

FittedMap makeVolume(const glm::dvec3& lightW, const glsl::CameraView& camera, const Bounds& sceneBoundsW,
                     const VolumeSize& size, VolumeFit fit) {
  FittedMap columns = columnsFor(lightW, camera, {}, sceneBoundsW.diagonal(), size, fit);
  columns.zFar = static_cast<float>(depthEndsWithin(sceneBoundsW, lightW, Distance::Radial, 0.0).zFar);
  return columns;
}

}  // namespace gnomon
