#include "shadow/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

// A convex polygon clipped by at most six planes: three corners and one more a plane.
struct Polygon {
  std::array<glm::dvec3, 9> corners;
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

// A window side as a half space of the light's frame, with depth = -z: u >= lo is x - lo*depth >= 0 in
// perspective and x - lo >= 0 without.
Polygon clipToWindow(Polygon polygon, const AxisFrame& frame, const Window& window, double least) {
  for (int axis = 0; axis < 2 && polygon.count > 0; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double bound = sign > 0.0 ? window.lower[axis] : window.upper[axis];
      glm::dvec3 normal(0.0);
      normal[axis] = sign;
      if (frame.perspective) normal.z = sign * bound;
      polygon = clip(polygon, frame.perspective ? 0.0 : -sign * bound, normal);
    }
  }
  return clip(polygon, -least, {0.0, 0.0, -1.0});
}

glm::dvec3 lightFromWorld(const AxisFrame& frame, const glm::dvec3& posW) {
  return glm::transpose(frame.worldFromLight) * (posW - frame.originW);
}

double nearestOfTriangle(const std::array<glm::dvec3, 3>& cornersL, const AxisFrame& frame,
                         const Window& window, double least, double nearest) {
  double depth = nearest;
  for (const glm::dvec3& corner : cornersL) depth = std::min(depth, -corner.z);
  if (depth >= nearest) return nearest;
  Polygon polygon;
  for (const glm::dvec3& corner : cornersL) polygon.corners[polygon.count++] = corner;
  polygon = clipToWindow(polygon, frame, window, least);
  for (int i = 0; i < polygon.count; ++i) nearest = std::min(nearest, -polygon.corners[i].z);
  return nearest;
}

}  // namespace

glm::dvec3 AxisFrame::planeFromWorld(const glm::dvec3& posW) const {
  const glm::dvec3 posL = lightFromWorld(*this, posW);
  const double depth = -posL.z;
  return perspective ? glm::dvec3(posL.x / depth, posL.y / depth, depth) : glm::dvec3(posL.x, posL.y, depth);
}

AxisFrame axisFrame(const glm::dvec3& originW, const glm::dvec3& directionW, bool perspective) {
  const glm::dvec3 back = -glm::normalize(directionW);
  const glm::dvec3 hint = std::abs(back.y) > 0.999 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(hint, back));
  return {.originW = originW,
          .worldFromLight = glm::dmat3(right, glm::cross(back, right), back),
          .perspective = perspective};
}

Window snapWindow(const Window& window, int side) {
  Window snapped;
  for (int axis = 0; axis < 2; ++axis) {
    const double extent = std::max(window.upper[axis] - window.lower[axis], 1e-9);
    // One texel is kept in hand for rounding the corner down.
    const double steps = std::ceil(std::log(extent / (side - 1)) / std::log(kTexelSizeStep));
    const double texel = std::pow(kTexelSizeStep, steps);
    snapped.lower[axis] = std::floor(window.lower[axis] / texel) * texel;
    snapped.upper[axis] = snapped.lower[axis] + texel * side;
  }
  return snapped;
}

double nearestCasterDepth(const Scene& scene, const AxisFrame& frame, const Window& window, double least,
                          double farthest) {
  double nearest = farthest;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 worldFromMesh(instance.worldFromMesh);
    const auto cornerL = [&](size_t index) {
      return lightFromWorld(frame,
                            glm::dvec3(worldFromMesh * glm::dvec4(mesh.positions[mesh.indices[index]], 1.0)));
    };
    nearest = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, mesh.indices.size() / 3, 4096), nearest,
        [&](const tbb::blocked_range<size_t>& range, double best) {
          for (size_t t = range.begin(); t != range.end(); ++t)
            best = nearestOfTriangle({cornerL(3 * t), cornerL(3 * t + 1), cornerL(3 * t + 2)}, frame, window,
                                     least, best);
          return best;
        },
        [](double a, double b) { return std::min(a, b); });
  }
  return nearest;
}

}  // namespace gnomon
