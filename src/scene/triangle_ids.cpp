#include "scene/triangle_ids.h"

#include "base/check.h"
#include "base/error.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace gnomon {

namespace {

// The more triangles a chunk has, the shorter the table, and the more ids the last chunk of an instance leaves unused.
constexpr uint32_t kMostShift = 16;

uint64_t chunksOf(uint64_t triangles, uint32_t shift) {
  return (triangles + (uint64_t{1} << shift) - 1) >> shift;
}

uint32_t largestShift(const std::vector<uint32_t>& triangleCounts) {
  for (uint32_t shift = kMostShift + 1; shift-- > 0;) {
    uint64_t ids = 0;
    for (const uint32_t count : triangleCounts) ids += chunksOf(count, shift) << shift;
    if (ids <= std::numeric_limits<uint32_t>::max()) return shift;
  }
  throw WorldError("the scene's instances have more than 4294967295 triangles together; leave some out");
}

}  // namespace

TriangleIds numberTriangles(const std::vector<uint32_t>& triangleCounts, const std::vector<uint32_t>& firstTriangles,
                            bool instanced) {
  TriangleIds ids;
  if (!instanced) {
    for (const uint32_t first : firstTriangles) ids.firstIds.push_back(first + 1);
    return ids;
  }
  ids.shift = largestShift(triangleCounts);
  for (size_t i = 0; i < triangleCounts.size(); ++i) {
    ids.firstIds.push_back(1 + (static_cast<uint32_t>(ids.chunks.size()) << ids.shift));
    for (uint64_t chunk = 0; chunk < chunksOf(triangleCounts[i], ids.shift); ++chunk)
      ids.chunks.push_back({.instance = static_cast<uint32_t>(i),
                            .firstTriangle = firstTriangles[i] + static_cast<uint32_t>(chunk << ids.shift)});
  }
  return ids;
}

glsl::PrimitiveId primitiveOf(const TriangleIds& ids, const std::vector<uint32_t>& firstTriangles, uint32_t id) {
  if (id == glsl::kNoId) return {0, 0};
  if (!ids.chunks.empty()) {
    GNOMON_CHECK_LT(glsl::idChunk(id, ids.shift), ids.chunks.size());
    const glsl::PlacedTriangle placed = glsl::placedInChunk(ids.chunks[glsl::idChunk(id, ids.shift)], id, ids.shift);
    return {placed.instance + 1, placed.triangle - firstTriangles[placed.instance]};
  }
  // Instances need not be in the order of their meshes.
  size_t owner = firstTriangles.size();
  for (size_t i = 0; i < firstTriangles.size(); ++i)
    if (firstTriangles[i] < id && (owner == firstTriangles.size() || firstTriangles[i] >= firstTriangles[owner]))
      owner = i;
  GNOMON_CHECK_LT(owner, firstTriangles.size());
  return {static_cast<uint32_t>(owner) + 1, id - 1 - firstTriangles[owner]};
}

}  // namespace gnomon
