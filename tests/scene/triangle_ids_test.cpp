// Numbers of triangles: every one names its triangle again, in scenes with and without instances.
#include "scene/triangle_ids.h"
#include "base/error.h"

#include <set>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

void expectRoundTrip(const std::vector<uint32_t>& counts, const std::vector<uint32_t>& firsts, bool instanced) {
  const TriangleIds ids = numberTriangles(counts, firsts, instanced);
  std::set<uint32_t> seen;
  for (uint32_t i = 0; i < counts.size(); ++i) {
    for (uint32_t t = 0; t < counts[i]; ++t) {
      const uint32_t id = ids.firstIds[i] + t;
      ASSERT_NE(id, glsl::kNoId);
      ASSERT_TRUE(seen.insert(id).second);
      const glsl::PrimitiveId named = primitiveOf(ids, firsts, id);
      ASSERT_EQ(named.instancePlusOne, i + 1);
      ASSERT_EQ(named.triangle, t);
    }
  }
}

TEST(TriangleIds, NameEachTriangleOnce) {
  expectRoundTrip({5, 1, 700}, {700, 705, 0}, false);  // meshes in another order than their instances
  expectRoundTrip({5, 5, 1, 70000, 5}, {0, 0, 5, 6, 0}, true);
  EXPECT_EQ(primitiveOf(numberTriangles({5}, {0}, true), {0}, glsl::kNoId).instancePlusOne, 0u);
}

TEST(TriangleIds, TakeSmallerChunksWhereTheyWouldNotFit) {
  const std::vector<uint32_t> counts(1u << 20, 2), firsts(1u << 20, 0);
  const TriangleIds ids = numberTriangles(counts, firsts, true);
  EXPECT_LE(ids.shift, 11u);
  EXPECT_EQ(primitiveOf(ids, firsts, ids.firstIds.back() + 1).instancePlusOne, counts.size());
  EXPECT_THROW(numberTriangles(std::vector<uint32_t>(5, 1u << 30), std::vector<uint32_t>(5, 0), true), WorldError);
}

}  // namespace
}  // namespace gnomon
