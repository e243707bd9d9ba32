#include "lab/volume/volume_pictures.h"

#include "base/check.h"
#include "lab/picture/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr glm::u8vec3 kLit(222, 222, 222);
constexpr glm::u8vec3 kShadow(70, 72, 78);
constexpr glm::u8vec3 kBoundary(213, 94, 0);  // vermillion
constexpr glm::u8vec3 kPlane(86, 180, 233);   // sky blue
constexpr glm::u8vec3 kShell(240, 228, 66);   // yellow
constexpr glm::u8vec3 kStrip(16, 20, 38);
constexpr glm::u8vec3 kText(235, 235, 235);

constexpr double kPlaneStep = 10.0;  // degrees of theta
constexpr double kShellStep = 5.0;   // degrees of alpha

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

void setPixel(Image8& image, int x, int y, const glm::u8vec3& color) {
  uint8_t* p = image.at(x, y);
  for (int c = 0; c < 3; ++c) p[c] = color[c];
}

struct Voxel {
  int alpha = 0, theta = 0, phi = 0;
};

// What a slice's pixel shows.
Voxel voxelOf(SliceAxis axis, int index, int x, int y) {
  switch (axis) {
    case SliceAxis::Alpha:
      return {index, x, y};
    case SliceAxis::Theta:
      return {x, index, y};
    case SliceAxis::Phi:
      return {x, y, index};
  }
  return {};
}

struct SliceSize {
  int width = 0, height = 0, count = 0;  // count: slices along the axis
};

SliceSize sliceSize(const glsl::EpipolarGrid& grid, SliceAxis axis) {
  switch (axis) {
    case SliceAxis::Alpha:
      return {grid.thetaCount, grid.phiCount, grid.alphaCount};
    case SliceAxis::Theta:
      return {grid.alphaCount, grid.phiCount, grid.thetaCount};
    case SliceAxis::Phi:
      return {grid.alphaCount, grid.thetaCount, grid.phiCount};
  }
  return {};
}

// Where along the axis the slice lies, in its centre.
double sliceDegrees(const glsl::EpipolarGrid& grid, SliceAxis axis, int index) {
  switch (axis) {
    case SliceAxis::Alpha:
      return degrees(glsl::alphaCenter(grid, index));
    case SliceAxis::Theta:
      return degrees(grid.thetaLower + (index + 0.5) * grid.thetaStep);
    case SliceAxis::Phi:
      return degrees(grid.phiLower + (index + 0.5) * grid.phiStep);
  }
  return 0.0;
}

std::string sliceTitle(const glsl::EpipolarGrid& grid, SliceAxis axis, int index) {
  const char* across = axis == SliceAxis::Alpha ? "theta" : "alpha";
  const char* down = axis == SliceAxis::Phi ? "theta" : "phi";
  return fmt::format("{} = {:.1f} degrees (slice {} of {}); across {}, down {}; orange: the exact boundary",
                     sliceAxisName(axis), sliceDegrees(grid, axis, index), index, sliceSize(grid, axis).count, across,
                     down);
}

// Words in lines that fit the width.
std::vector<std::string> wrapped(const std::string& text, int scale, int width) {
  std::vector<std::string> lines(1);
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (textWidth(scale, longer) <= width || lines.back().empty())
      lines.back() = longer;
    else
      lines.push_back(word);
    begin = end + 1;
  }
  return lines;
}

// The picture with a strip of text below it.
Image8 withCaption(const Image8& image, const std::string& text) {
  const int scale = std::max(1, image.width / 500);
  const std::vector<std::string> lines = wrapped(text, scale, image.width - 8 * scale);
  const int lineHeight = 12 * scale;
  Image8 captioned(image.width, image.height + static_cast<int>(lines.size()) * lineHeight + 2 * scale, 3);
  std::ranges::copy(image.values, captioned.values.begin());
  for (int y = image.height; y < captioned.height; ++y)
    for (int x = 0; x < captioned.width; ++x) setPixel(captioned, x, y, kStrip);
  int top = image.height + 4 * scale;
  for (const std::string& line : lines) {
    drawText(captioned, 4 * scale, top, scale, line, kText);
    top += lineHeight;
  }
  return captioned;
}

bool exactlyOccluded(const ColumnBoundaries& exact, const Voxel& v) {
  return exact.first[columnIndex(exact.grid, v.theta, v.phi)] <= v.alpha;
}

// Occluded, beside a lit neighbour across or down.
bool onBoundary(const ColumnBoundaries& exact, SliceAxis axis, int index, const SliceSize& size, int x, int y) {
  const auto occluded = [&](int px, int py) { return exactlyOccluded(exact, voxelOf(axis, index, px, py)); };
  if (!occluded(x, y)) return false;
  return (x > 0 && !occluded(x - 1, y)) || (y > 0 && !occluded(x, y - 1)) ||
         (x + 1 < size.width && !occluded(x + 1, y)) || (y + 1 < size.height && !occluded(x, y + 1));
}

// A pixel's view ray in the volume's coordinates.
struct ViewRay {
  double theta = 0.0, alpha = 0.0;  // degrees
  bool inside = false;
};

ViewRay viewRay(const glsl::CameraView& view, const glsl::LightFrame& frame, const glsl::EpipolarGrid& grid, int x,
                int y) {
  const glm::vec3 directionL = glsl::directionFromWorld(frame, glsl::unitVector(glsl::pixelDirection(view, x, y)));
  // A point of the ray one D from the eye, so that rounding of D does not matter.
  const glm::vec3 posL = glm::vec3(0.0f, 0.0f, grid.eyeDistance) + directionL * grid.eyeDistance;
  const glsl::EpipolarPoint point = glsl::epipolarFromLight(grid.eyeDistance, posL);
  const float alphaSteps = (point.alpha - grid.alphaLower) / grid.alphaStep;
  return {.theta = degrees(point.theta),
          .alpha = degrees(point.alpha),
          .inside = alphaSteps >= 0.0f && alphaSteps <= static_cast<float>(grid.alphaCount) &&
                    glsl::thetaSteps(grid, point.theta) <= static_cast<float>(grid.thetaCount)};
}

// Whether a multiple of `step` lies between two angles; a jump of half a turn is the seam of theta.
bool crosses(double a, double b, double step) {
  return std::abs(a - b) < 180.0 && std::floor(a / step) != std::floor(b / step);
}

}  // namespace

const char* sliceAxisName(SliceAxis axis) {
  switch (axis) {
    case SliceAxis::Alpha:
      return "alpha";
    case SliceAxis::Theta:
      return "theta";
    case SliceAxis::Phi:
      return "phi";
  }
  return "?";
}

Image8 slicePicture(const DenseVolume& volume, const ColumnBoundaries& exact, SliceAxis axis, int index) {
  const SliceSize size = sliceSize(volume.grid, axis);
  GNOMON_CHECK_LT(index, size.count);
  Image8 image(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Voxel v = voxelOf(axis, index, x, y);
      const bool line = onBoundary(exact, axis, index, size, x, y);
      setPixel(image, x, y, line ? kBoundary : volume.bit(v.alpha, v.theta, v.phi) ? kShadow : kLit);
    }
  }
  return withCaption(image, sliceTitle(volume.grid, axis, index));
}

int busiestSlice(const ColumnBoundaries& exact, SliceAxis axis) {
  const glsl::EpipolarGrid& grid = exact.grid;
  const auto first = [&](int theta, int phi) { return exact.first[columnIndex(grid, theta, phi)]; };
  std::vector<int64_t> weight(sliceSize(grid, axis).count, 0);
  for (int phi = 1; phi < grid.phiCount; ++phi) {
    for (int theta = 1; theta < grid.thetaCount; ++theta) {
      const int here = first(theta, phi);
      if (axis == SliceAxis::Theta)
        weight[theta] += std::abs(here - first(theta, phi - 1));
      else if (axis == SliceAxis::Phi)
        weight[phi] += std::abs(here - first(theta - 1, phi));
      else if (here > 0 && here < grid.alphaCount)
        ++weight[here];
    }
  }
  return static_cast<int>(std::ranges::max_element(weight) - weight.begin());
}

Image8 coordinatePicture(const Image8& camera, const glsl::CameraView& view, const glsl::LightFrame& frame,
                         const glsl::EpipolarGrid& grid) {
  GNOMON_CHECK_EQ(camera.width, view.width);
  GNOMON_CHECK_EQ(camera.height, view.height);
  Image8 image = camera;
  for (uint8_t& value : image.values) value = static_cast<uint8_t>(value * 3 / 4);  // lines stand out
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const ViewRay here = viewRay(view, frame, grid, x, y);
      for (const ViewRay& beside : {viewRay(view, frame, grid, x + 1, y), viewRay(view, frame, grid, x, y + 1)}) {
        if (crosses(here.theta, beside.theta, kPlaneStep)) setPixel(image, x, y, kPlane);
        if (crosses(here.alpha, beside.alpha, kShellStep)) setPixel(image, x, y, kShell);
        if (here.inside != beside.inside) setPixel(image, x, y, kBoundary);
      }
    }
  }
  return withCaption(image, fmt::format("blue: planes of theta every {:.0f} degrees; yellow: shells of alpha "
                                        "every {:.0f}; orange: the volume's ends",
                                        kPlaneStep, kShellStep));
}

}  // namespace gnomon
