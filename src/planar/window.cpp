#include "planar/window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

// A convex polygon clipped by at most five planes: three corners and one more a plane.
struct Polygon {
  std::array<glm::dvec3, 8> corners;
  int count = 0;
};

// Keeps the part where a + b.p >= 0. Sutherland and Hodgman 1974.
Polygon clip(const Polygon& polygon, double a, const glm::dvec3& b) {
  Polygon out;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& p = polygon.corners[i];
    const glm::dvec3& q = polygon.corners[(i + 1) % polygon.count];
    const double dp = a + glm::dot(b, p);
    const double dq = a + glm::dot(b, q);
    if (dp >= 0.0) out.corners[out.count++] = p;
    if ((dp >= 0.0) != (dq >= 0.0)) out.corners[out.count++] = p + (q - p) * (dp / (dp - dq));
  }
  return out;
}

// The sides of a slice and its near end as half spaces of the light's frame. A row r of clipFromPlane is
// r.x x + r.y y + r.z (1 or -z) there.
struct HalfSpace {
  double a = 0.0;
  glm::dvec3 b{0.0};
};
using SliceVolume = std::array<HalfSpace, 5>;

SliceVolume sliceVolume(const AxisFrame& frame, const glm::dmat3& clipFromPlane, double least) {
  const glm::dmat3 rows = glm::transpose(clipFromPlane);
  SliceVolume volume;
  for (int axis = 0; axis < 2; ++axis) {
    for (const int sign : {1, -1}) {
      const glm::dvec3 side = rows[2] + static_cast<double>(sign) * rows[axis];
      volume[static_cast<size_t>(2 * axis + (sign > 0 ? 0 : 1))] =
          frame.perspective ? HalfSpace{.b = {side.x, side.y, -side.z}}
                            : HalfSpace{.a = side.z, .b = {side.x, side.y, 0.0}};
    }
  }
  volume[4] = {.a = -least, .b = {0.0, 0.0, -1.0}};
  return volume;
}

Polygon clipToVolume(const std::array<glm::dvec3, 3>& cornersL, const SliceVolume& volume) {
  Polygon polygon;
  for (const glm::dvec3& corner : cornersL) polygon.corners[polygon.count++] = corner;
  for (const HalfSpace& side : volume) {
    if (polygon.count == 0) break;
    polygon = clip(polygon, side.a, side.b);
  }
  return polygon;
}

// The greatest value that `valueOf` takes at a corner of a triangle's part within the volume, but at least
// `start`. `mayExceed` passes a whole triangle over.
template <typename MayExceed, typename ValueOf>
double greatestOfCasters(const Scene& scene, const AxisFrame& frame, const SliceVolume& volume, double start,
                         const MayExceed& mayExceed, const ValueOf& valueOf) {
  for (const Instance& instance : scene.instances) {
    if (!instance.casts) continue;
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 worldFromMesh(instance.worldFromMesh);
    const auto cornerL = [&](size_t index) {
      return frame.lightFromWorld(glm::dvec3(worldFromMesh * glm::dvec4(mesh.positions[mesh.indices[index]], 1.0)));
    };
    start = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, mesh.indices.size() / 3, 4096), start,
        [&](const tbb::blocked_range<size_t>& range, double best) {
          for (size_t t = range.begin(); t != range.end(); ++t) {
            const std::array<glm::dvec3, 3> corners = {cornerL(3 * t), cornerL(3 * t + 1), cornerL(3 * t + 2)};
            if (!mayExceed(corners, best)) continue;
            const Polygon polygon = clipToVolume(corners, volume);
            for (int i = 0; i < polygon.count; ++i) best = std::max(best, valueOf(polygon.corners[i]));
          }
          return best;
        },
        [](double a, double b) { return std::max(a, b); });
  }
  return start;
}

}  // namespace

glm::dvec3 AxisFrame::planeFromWorld(const glm::dvec3& posW) const {
  const glm::dvec3 posL = lightFromWorld(posW);
  const double depth = -posL.z;
  return perspective ? glm::dvec3(posL.x / depth, posL.y / depth, depth) : glm::dvec3(posL.x, posL.y, depth);
}

glm::dvec3 AxisFrame::lightFromWorld(const glm::dvec3& posW) const {
  return glm::transpose(worldFromLight) * (posW - originW);
}

AxisFrame axisFrame(const glm::dvec3& originW, const glm::dvec3& directionW, bool perspective) {
  const glm::dvec3 back = -glm::normalize(directionW);
  const glm::dvec3 hint = std::abs(back.y) > 0.999 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(hint, back));
  return {.originW = originW,
          .worldFromLight = glm::dmat3(right, glm::cross(back, right), back),
          .perspective = perspective};
}

Window windowOf(std::span<const glm::dvec2> points) {
  Window window{.lower = glm::dvec2(std::numeric_limits<double>::max()),
                .upper = glm::dvec2(std::numeric_limits<double>::lowest())};
  for (const glm::dvec2& point : points) {
    window.lower = glm::min(window.lower, point);
    window.upper = glm::max(window.upper, point);
  }
  return window;
}

double snapLength(double length) {
  return std::pow(kTexelSizeStep, std::ceil(std::log(length) / std::log(kTexelSizeStep)));
}

Window snapWindow(const Window& window, int side) {
  Window snapped;
  for (int axis = 0; axis < 2; ++axis) {
    const double extent = std::max(window.upper[axis] - window.lower[axis], 1e-9);
    // One texel is kept in hand for rounding the corner down.
    const double texel = snapLength(extent / (side - 1));
    snapped.lower[axis] = std::floor(window.lower[axis] / texel) * texel;
    snapped.upper[axis] = snapped.lower[axis] + texel * side;
  }
  return snapped;
}

glm::dmat3 clipFromPlane(const Window& window) {
  const glm::dvec2 scale = 2.0 / (window.upper - window.lower);
  const glm::dvec2 center = 0.5 * (window.upper + window.lower);
  return glm::dmat3({scale.x, 0.0, 0.0}, {0.0, -scale.y, 0.0}, {-scale.x * center.x, scale.y * center.y, 1.0});
}

// The ray at (X, Y, 1) of the slice is h = inverse * (X, Y, 1), and its W is 1 / h.z for h.z = 1, so that
// h.z, which is linear over the square, has its extremes at the corners.
WRange wRange(const glm::dmat3& clipFromPlane) {
  const glm::dmat3 planeFromClip = glm::inverse(clipFromPlane);
  double least = std::numeric_limits<double>::max();
  double greatest = std::numeric_limits<double>::lowest();
  for (const glm::dvec2& corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
    const double z = (planeFromClip * glm::dvec3(corner, 1.0)).z;
    least = std::min(least, z);
    greatest = std::max(greatest, z);
  }
  return {.least = least > 0.0 ? 1.0 / greatest : -1.0, .greatest = least > 0.0 ? 1.0 / least : -1.0};
}

double nearestCasterDepth(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane, double least,
                          double farthest) {
  const auto mayExceed = [](const std::array<glm::dvec3, 3>& cornersL, double best) {
    return std::max({cornersL[0].z, cornersL[1].z, cornersL[2].z}) > best;
  };
  return -greatestOfCasters(scene, frame, sliceVolume(frame, clipFromPlane, least), -farthest, mayExceed,
                            [](const glm::dvec3& posL) { return posL.z; });
}

double farthestCasterDepth(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane,
                           double nearest) {
  const auto mayExceed = [](const std::array<glm::dvec3, 3>& cornersL, double best) {
    return -std::min({cornersL[0].z, cornersL[1].z, cornersL[2].z}) > best;
  };
  return greatestOfCasters(scene, frame, sliceVolume(frame, clipFromPlane, nearest), nearest, mayExceed,
                           [](const glm::dvec3& posL) { return -posL.z; });
}

// The reach is a quotient of linear functions, W positive, so that a polygon has its greatest at a corner.
double casterReach(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane, double least,
                   double from, Reach side) {
  const double sign = side == Reach::Behind ? 1.0 : -1.0;
  const auto reach = [&](const glm::dvec3& posL) {
    const glm::dvec3 h =
        frame.perspective ? glm::dvec3(posL.x / -posL.z, posL.y / -posL.z, 1.0) : glm::dvec3(posL.x, posL.y, 1.0);
    return sign * (frame.linearDepth(-posL.z) - frame.linearDepth(from)) / (clipFromPlane * h).z;
  };
  return greatestOfCasters(
      scene, frame, sliceVolume(frame, clipFromPlane, least), 0.0, [](const auto&, double) { return true; }, reach);
}

}  // namespace gnomon
