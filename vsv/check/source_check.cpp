#include "vsv/check/source_check.h"

#include "shared/volume_source.glsl"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

using Range = tbb::blocked_range<int>;

// By how much two processors' directions of one column may differ along an axis of the source's frame: 2.5 ulps of sin
// and cos (volume_check.cpp), and two rotations of three products and two sums each, 2 ulps apiece.
constexpr float kDirectionNoise = 6.5f * 0x1p-23f;

float phiCenter(const glsl::EpipolarGrid& grid, int phi) {
  return grid.phiLower + (static_cast<float>(phi) + 0.5f) * grid.phiStep;
}

// A value of sums and products alone, where a device may fuse the two.
float fusedTolerance(float value) {
  return std::isfinite(value) ? 0x1p-22f * std::abs(value) : 0.0f;
}

// The source's map with its depths in host memory.
struct HostSource {
  const FittedMap& columns;
  const FittedMap& map;
  std::vector<float> depths;

  bool isColumns() const { return map.map.kind == glsl::kMapEpipolar; }

  float depthAt(int slice, const glm::ivec2& texel) const {
    const size_t rows = map.map.height, side = map.map.width;
    return depths[(slice * rows + texel.y) * side + texel.x];
  }
};

glm::vec3 columnDirection(const FittedMap& columns, int theta, int phi) {
  return glsl::mapTexelRay(columns.map, 0, glsl::mapTexelCenter(columns.map, {theta, phi})).dir;
}

struct Found {
  float alpha = 0.0f;
  bool betweenTexels = false;
};

// Of the texels that rounding may choose, the one whose answer is nearest the GPU's.
Found lookUp(const HostSource& source, const glm::vec3& dirL, float measured) {
  const glsl::ShadowMap& map = source.map.map;
  const glm::vec3 dirS = glsl::sourceDirection(source.columns.frame, source.map.frame, dirL);
  const auto alphaAt = [&](const glsl::MapPoint& place) {
    return glsl::alphaLookedUp(map, place, source.depthAt(place.slice, glsl::mapTexel(map, place.uv)), dirS, dirL,
                               source.columns.map.epipolar.eyeDistance);
  };
  const glsl::MapPoint center = glsl::mapProject(map, dirS);
  const glm::ivec2 centerTexel = glsl::mapTexel(map, center.uv);
  Found found{.alpha = alphaAt(center)};
  if (found.alpha == measured) return found;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 sign((corner & 1) != 0 ? 1.0f : -1.0f, (corner & 2) != 0 ? 1.0f : -1.0f,
                         (corner & 4) != 0 ? 1.0f : -1.0f);
    const glsl::MapPoint place = glsl::mapProject(map, dirS + sign * kDirectionNoise);
    if (place.slice == center.slice && glsl::mapTexel(map, place.uv) == centerTexel) continue;
    found.betweenTexels = true;
    const float alpha = alphaAt(place);
    if (alpha == measured || std::abs(alpha - measured) < std::abs(found.alpha - measured)) found.alpha = alpha;
  }
  return found;
}

struct HostOccluders {
  std::vector<float> alpha, tolerance;  // radians, by columnIndex
  std::vector<uint8_t> betweenTexels;
};

HostOccluders findOccluders(const HostSource& source, std::span<const float> measured) {
  const glsl::EpipolarGrid& grid = source.columns.map.epipolar;
  HostOccluders host{.alpha = std::vector<float>(measured.size()),
                     .tolerance = std::vector<float>(measured.size()),
                     .betweenTexels = std::vector<uint8_t>(measured.size(), 0)};
  tbb::parallel_for(Range(0, grid.phiCount), [&](const Range& phis) {
    for (int phi = phis.begin(); phi != phis.end(); ++phi) {
      for (int theta = 0; theta < grid.thetaCount; ++theta) {
        const size_t c = columnIndex(grid, theta, phi);
        if (source.isColumns()) {
          host.alpha[c] = glsl::alphaDrawn(grid, source.depthAt(0, {theta, phi}));
          host.tolerance[c] = fusedTolerance(host.alpha[c]);
          continue;
        }
        const Found found = lookUp(source, columnDirection(source.columns, theta, phi), measured[c]);
        host.alpha[c] = found.alpha;
        host.betweenTexels[c] = found.betweenTexels;
        host.tolerance[c] = alphaTolerance(found.alpha, phiCenter(grid, phi));
      }
    }
  });
  return host;
}

const FittedMap& sourceOf(const ShadowVolume& volume) {
  const FittedMap& columns = volume.fitted();
  return columns.occluderSource ? *columns.occluderSource : columns;
}

// The ray through the centre of the texel that a column is looked up in.
RayD sourceRayW(const FittedMap& columns, const FittedMap& source, int theta, int phi) {
  const glm::vec3 dirS = glsl::sourceDirection(columns.frame, source.frame, columnDirection(columns, theta, phi));
  const glsl::MapPoint point = glsl::mapProject(source.map, dirS);
  const glm::vec2 center = glsl::mapTexelCenter(source.map, glsl::mapTexel(source.map, point.uv));
  const glm::dvec3 dir(glsl::mapTexelRay(source.map, point.slice, center).dir);
  const glsl::LightFrame& frame = source.frame;
  return {.origin = glm::dvec3(frame.originW),
          .dir = glm::normalize(glm::dvec3(frame.rightW) * dir.x + glm::dvec3(frame.upW) * dir.y +
                                glm::dvec3(frame.backW) * dir.z)};
}

}  // namespace

DenseVolume denseOf(const VolumeBits& bits) {
  const glsl::EpipolarGrid& grid = bits.grid();
  DenseVolume dense(grid);
  tbb::parallel_for(Range(0, grid.alphaCount), [&](const Range& alphas) {
    for (int alpha = alphas.begin(); alpha != alphas.end(); ++alpha)
      for (int theta = 0; theta < grid.thetaCount; ++theta)
        for (int w = 0; w < dense.phiWordCount(); ++w) {
          const int phi = w * kWordBits;
          const glm::uvec4& texel = bits.texels()[glsl::epipolarTexelIndex(grid, alpha, theta, phi / glsl::kPhiBits)];
          const int first = phi % glsl::kPhiBits / 32;
          dense.words[dense.wordIndex(alpha, theta, w)] = texel[first] | static_cast<uint64_t>(texel[first + 1]) << 32;
        }
  });
  return dense;
}

SourceCheck checkSource(const gpu::Device& device, const ShadowVolume& volume, const DenseVolume& measured) {
  const HostSource source{volume.fitted(), sourceOf(volume), gpu::downloadAs<float>(device, volume.source().depth())};
  const std::vector<float> occluders = gpu::downloadAs<float>(device, volume.occluders());
  const HostOccluders host = findOccluders(source, occluders);
  std::vector<float> fused(occluders.size());
  std::ranges::transform(occluders, fused.begin(), fusedTolerance);
  return {.occluders = checkOccluders(occluders, host.alpha, host.tolerance),
          .betweenTexels = static_cast<uint64_t>(std::ranges::count(host.betweenTexels, static_cast<uint8_t>(1))),
          .implied = impliedBoundaries(measured.grid, host.alpha),
          .sameMap = checkBits(measured, host.alpha, host.tolerance),
          .sameOccluders = checkBits(measured, occluders, fused)};
}

ColumnSource columnSource(const ShadowVolume& volume) {
  ColumnSource source;
  const glsl::EpipolarGrid grid = volume.grid();
  source.rounding = [grid](double alphaOccluder, int phi) {
    return static_cast<double>(alphaTolerance(static_cast<float>(alphaOccluder), phiCenter(grid, phi)));
  };
  const FittedMap& map = sourceOf(volume);
  if (map.map.kind == glsl::kMapEpipolar) return source;
  source.rayW = [&volume, &map](int theta, int phi) { return sourceRayW(volume.fitted(), map, theta, phi); };
  source.covers = [&map](const glm::dvec3& positionW) {
    const glm::vec3 posL = glsl::lightFromWorld(map.frame, glm::vec3(positionW));
    const glsl::MapPoint point = glsl::mapProject(map.map, posL);
    const float depth = glsl::mapDepth(map.map, point.slice, posL);
    return point.covered && depth >= 0.0f && depth < 1.0f;
  };
  return source;
}

}  // namespace gnomon
