#include "shadow/slice_culling.h"

#include <algorithm>

namespace gnomon {

namespace {

// Of the coordinates of clip space: a point is projected to within a few ulps. What is let through is clipped anyway.
constexpr float kSlack = 1e-3f;

}  // namespace

SliceCulling::SliceCulling(const FittedMap& fitted, int first, int count) : frame_(fitted.frame) {
  for (int slice = first; slice < first + count; ++slice) {
    if (!fitted.halfSpaces.empty()) {
      const FittedMap::HalfSpace& half = fitted.halfSpaces[static_cast<size_t>(slice)];
      hemispheres_.push_back({.axisZ = half.axisZ, .backW = frame_.backW, .beyondRim = half.beyond + kSlack});
    }
    if (!fitted.shaders.projective) continue;
    const glm::mat4 rows = glm::transpose(fitted.map.mapSlices[slice].clipFromLight);
    Projective made{.fromLight = {rows[0], rows[1], rows[3]}, .fromWorld = {}};
    for (int i = 0; i < 3; ++i)
      made.fromWorld[i] =
          frame_.rightW * made.fromLight[i].x + frame_.upW * made.fromLight[i].y + frame_.backW * made.fromLight[i].z;
    projective_.push_back(made);
  }
}

// A box lies outside one side of the clip volume where +-x - w (+-y - w) is positive in all of it; over the
// box such a sum is what it is at the centre, give or take the half size times its gradient.
bool SliceCulling::Projective::mayShow(const glm::vec3& centerL, const glm::vec3& halfSizeW) const {
  float center[3], sum = 0.0f;
  for (int i = 0; i < 3; ++i) {
    center[i] = glm::dot(fromLight[i], glm::vec4(centerL, 1.0f));
    sum += std::abs(center[i]) + glm::dot(glm::abs(fromWorld[i]), halfSizeW);
  }
  for (int axis = 0; axis < 2; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      const glm::vec3 gradient = sign * fromWorld[axis] - fromWorld[2];
      const float least = sign * center[axis] - center[2] - glm::dot(glm::abs(gradient), halfSizeW);
      if (least > kSlack * sum) return false;
    }
  }
  return true;
}

// Where the most forward of the box is behind the light by more than the rim shows, all of it is.
bool SliceCulling::Hemisphere::mayShow(const glm::vec3& centerL, const glm::vec3& halfSizeW) const {
  const float forward = axisZ * centerL.z + glm::dot(glm::abs(backW), halfSizeW);
  return forward >= -beyondRim * (glm::length(centerL) + glm::length(halfSizeW));
}

bool SliceCulling::mayShow(const Bounds& boundsW) const {
  const glm::vec3 centerL = glsl::lightFromWorld(frame_, 0.5f * (boundsW.lower + boundsW.upper));
  const glm::vec3 halfSizeW = 0.5f * (boundsW.upper - boundsW.lower);
  const auto shows = [&](const auto& slice) { return slice.mayShow(centerL, halfSizeW); };
  return (projective_.empty() && hemispheres_.empty()) || std::ranges::any_of(projective_, shows) ||
         std::ranges::any_of(hemispheres_, shows);
}

std::vector<SliceCulling::Range> SliceCulling::rangesOf(const SceneBuffers& scene, const Draw& draw) const {
  if (!draw.casts || !mayShow(draw.boundsW)) return {};
  if (draw.partCount == 0) return {{draw.firstIndex, draw.indexCount}};
  std::vector<Range> ranges;
  bool goesOn = false;
  for (uint32_t part = 0; part < draw.partCount; ++part) {
    const bool shown = mayShow(scene.partBoundsW[draw.firstPart + part]);
    const uint32_t begin = part * kPartIndices;
    const uint32_t count = std::min(kPartIndices, draw.indexCount - begin);
    if (shown && goesOn)
      ranges.back().indexCount += count;
    else if (shown)
      ranges.push_back({draw.firstIndex + begin, count});
    goesOn = shown;
  }
  return ranges;
}

}  // namespace gnomon
