#include "omni/caster_range.h"

#include "base/error.h"
#include "base/parse.h"
#include "planar/window.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

// A near end cannot stand nearer to the light than this share of the scene's diagonal (as planar maps have it): 32-bit
// positions in a scene of that size are good to 2^-24 of the diagonal, so that what is nearer has a direction that is
// off by more than half a percent, and a surface that holds the light itself would leave no depth.
constexpr double kLeastNear = 1e-5;
// Far more than what 32-bit positions round (1e-7 of the far end), far less than what costs precision.
constexpr double kEndSlack = 1e-3;

// Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: the Voronoi regions of a triangle's features.
glm::dvec3 nearestToOrigin(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a;
  const double d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const double d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1.0 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

double nearestOfMesh(const Mesh& mesh, const glm::dmat4& lightFromMesh, double nearest) {
  const auto corner = [&](size_t index) {
    return glm::dvec3(lightFromMesh * glm::dvec4(mesh.positions[mesh.indices[index]], 1.0));
  };
  return tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, mesh.indices.size() / 3, 4096), nearest,
      [&](const tbb::blocked_range<size_t>& range, double best) {
        for (size_t t = range.begin(); t != range.end(); ++t) {
          const double d = glm::length(nearestToOrigin(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)));
          if (d < best) best = d;  // and not where it is NaN: a triangle without area
        }
        return best;
      },
      [](double a, double b) { return std::min(a, b); });
}

double nearestRadial(const Scene& scene, const glm::dvec3& lightW, double farthest) {
  double nearest = farthest;
  for (const Instance& instance : scene.instances) {
    if (!instance.casts) continue;
    glm::dmat4 lightFromMesh(instance.worldFromMesh);
    lightFromMesh[3] -= glm::dvec4(lightW, 0.0);
    nearest = nearestOfMesh(scene.meshes[instance.mesh], lightFromMesh, nearest);
  }
  return nearest;
}

// The nearest depth within the pyramid of each face.
double nearestAxial(const Scene& scene, const glm::dvec3& lightW, double least, double farthest) {
  double nearest = farthest;
  for (int face = 0; face < 6; ++face) {
    glm::dvec3 axisW(0.0);
    axisW[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    const glm::dmat3 face90 = clipFromPlane({.lower = glm::dvec2(-1.0), .upper = glm::dvec2(1.0)});
    nearest = nearestCasterDepth(scene, axisFrame(lightW, axisW, true), face90, least, nearest);
  }
  return nearest;
}

std::optional<DepthEnds> parseRange(const std::string& flag, const std::string& text) {
  if (text == "auto") return std::nullopt;
  const size_t comma = text.find(',');
  const double zNear = parseNumber(text.substr(0, comma)).value_or(0.0);
  const double zFar = comma == std::string::npos ? 0.0 : parseNumber(text.substr(comma + 1)).value_or(0.0);
  if (!(zNear > 0.0 && zNear < zFar))
    throw UsageError(fmt::format("{} {}: write NEAR,FAR in metres, 0 < NEAR < FAR, or auto", flag, text));
  return DepthEnds{.zNear = zNear, .zFar = zFar};
}

std::string rangeText(const std::optional<DepthEnds>& ends) {
  return ends ? fmt::format("{},{}", ends->zNear, ends->zFar) : "auto";
}

double distanceOf(const glm::dvec3& posL, Distance distance) {
  if (distance == Distance::Radial) return glm::length(posL);
  return std::max({std::abs(posL.x), std::abs(posL.y), std::abs(posL.z)});
}

double farthestCorner(const Bounds& bounds, const glm::dvec3& lightW, Distance distance) {
  double farthest = 0.0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 cornerW(i & 1 ? bounds.upper.x : bounds.lower.x, i & 2 ? bounds.upper.y : bounds.lower.y,
                             i & 4 ? bounds.upper.z : bounds.lower.z);
    farthest = std::max(farthest, distanceOf(cornerW - lightW, distance));
  }
  return farthest;
}

}  // namespace

double nearestCaster(const Scene& scene, const glm::dvec3& lightW, Distance distance, double least, double farthest) {
  const double nearest = distance == Distance::Radial ? nearestRadial(scene, lightW, farthest)
                                                      : nearestAxial(scene, lightW, least, farthest);
  return std::max(nearest, least);
}

double farthestReceiver(const Scene& scene, const glm::dvec3& lightW, Distance distance,
                        std::span<const glm::dvec3> receiversW) {
  double farthest = 0.0;
  for (const glm::dvec3& receiver : receiversW) farthest = std::max(farthest, distanceOf(receiver - lightW, distance));
  if (!receiversW.empty()) return farthest;
  return farthestCorner(computeBounds(scene), lightW, distance);
}

DepthEnds fitDepthEnds(const Scene& scene, const glm::dvec3& lightW, Distance distance,
                       std::span<const glm::dvec3> receiversW) {
  const double scale = std::max(static_cast<double>(computeBounds(scene).diagonal()), 1e-30);
  const double farthest = std::max(farthestReceiver(scene, lightW, distance, receiversW), 2.0 * kLeastNear * scale);
  const double nearest = nearestCaster(scene, lightW, distance, kLeastNear * scale, farthest);
  return {.zNear = nearest * (1.0 - kEndSlack), .zFar = farthest * (1.0 + kEndSlack)};
}

DepthEnds depthEndsWithin(const Bounds& sceneBoundsW, const glm::dvec3& lightW, Distance distance, double zNear) {
  return {.zNear = zNear,
          .zFar = std::max(farthestCorner(sceneBoundsW, lightW, distance), 2.0 * zNear) * (1.0 + kEndSlack)};
}

constinit const WrittenOption<std::optional<DepthEnds>> kDepthRange(
    {.name = "depth_range",
     .sentence = "NEAR,FAR: ends of depth of a cube or a paraboloid; auto: the nearest caster, the farthest receiver",
     .unit = "metres"},
    std::nullopt, parseRange, rangeText);

DepthEnds chosenDepthEnds(const FitInput& input, Distance distance) {
  const std::optional<DepthEnds>& chosen = input.options.get(kDepthRange);
  return chosen ? *chosen : fitDepthEnds(input.scene, input.light.positionW, distance, input.receiversW);
}

}  // namespace gnomon
