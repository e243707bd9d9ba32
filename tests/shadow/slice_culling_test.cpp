// What is not sent to a slice is not seen on it, and much is not sent.
#include "shadow/slice_culling.h"

#include "seen_scene.h"
#include "tests/gpu_fixture.h"

#include "scene/generate.h"
#include "scene/mesh_builder.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

class SliceCullingTest : public gpu::GpuTest {
 protected:
  // Torus knots large and small around the origin, one turned, one mirrored, one too small to be cut.
  static Scene manyTori() {
    Scene scene;
    scene.materials.push_back({.name = "grey"});
    MeshBuilder large("large", 0), small("small", 0);
    large.torus({0, 0, 0}, 3.0, 0.7, 60, 41);
    small.torus({0, 0, 0}, 0.3, 0.1, 10, 8);
    scene.meshes = {large.build(), small.build()};
    for (int i = 0; i < 12; ++i) {
      glm::mat4 world = glm::rotate(glm::mat4(1.0f), 0.7f * static_cast<float>(i), glm::vec3(1, 2, 3));
      world[3] = glm::vec4(4.0f * std::sin(2.0f * static_cast<float>(i)), static_cast<float>(i % 5) - 2.0f,
                           4.0f * std::cos(static_cast<float>(i)), 1.0f);
      if (i == 3) world[0] *= -1.0f;
      scene.instances.push_back({.name = "", .mesh = i % 2, .worldFromMesh = world});
    }
    return scene;
  }
};

TEST_F(SliceCullingTest, NoTriangleThatALayerMayShowIsLeftOutAndMostOthersAre) {
  const Scene scene = manyTori();
  const SceneBuffers buffers = createSceneBuffers(device(), scene);
  size_t all = 0, needed = 0, drawn = 0, uncut = 0;
  for (int way = 0; way < 40; ++way) {
    // A spot somewhere among them, wide or narrow.
    const glm::dvec3 aim(std::sin(way), std::cos(2.0 * way), std::sin(3.0 * way + 1.0));
    const LightModel light{.type = LightType::Spot,
                           .positionW = glm::dvec3(std::cos(5.0 * way), 0.5, std::sin(7.0 * way)),
                           .directionW = glm::normalize(aim),
                           .outerConeRad = way % 2 == 0 ? 0.2 : 0.7};
    const FittedMap fitted =
        spotParameterization().fit({.scene = scene,
                                    .light = light,
                                    .receiversW = {},
                                    .side = 64,
                                    .camera = cameraView(lookAt("any", {9, 9, 9}, {0, 0, 0}, 1.0f), 8, 8)});
    const SliceCulling culling(fitted, 0, 1);
    for (const Draw& draw : buffers.draws) {
      const Instance& instance = scene.instances[draw.instance];
      const Mesh& mesh = scene.meshes[instance.mesh];
      const auto ranges = culling.rangesOf(buffers, draw);
      uncut += culling.mayShow(draw.boundsW) ? draw.indexCount / 3 : 0;
      uint32_t end = 0;
      for (const SliceCulling::Range& range : ranges) {
        ASSERT_GE(range.firstIndex, std::max(end, draw.firstIndex));
        ASSERT_GT(range.indexCount, 0u);
        end = range.firstIndex + range.indexCount;
        ASSERT_LE(end, draw.firstIndex + draw.indexCount);
        drawn += range.indexCount / 3;
      }
      for (uint32_t i = 0; i < draw.indexCount; i += 3) {
        // Outside one side of the clip volume with all its corners: nothing of it is seen.
        bool outside[4] = {true, true, true, true};
        for (uint32_t corner = i; corner < i + 3; ++corner) {
          const glm::vec3 posW(instance.worldFromMesh * glm::vec4(mesh.positions[mesh.indices[corner]], 1.0f));
          const glm::vec4 clip = glsl::transform(fitted.map.mapSlices[0].clipFromLight,
                                                 glm::vec4(glsl::lightFromWorld(fitted.frame, posW), 1.0f));
          outside[0] = outside[0] && clip.x > clip.w;
          outside[1] = outside[1] && -clip.x > clip.w;
          outside[2] = outside[2] && clip.y > clip.w;
          outside[3] = outside[3] && -clip.y > clip.w;
        }
        ++all;
        if (outside[0] || outside[1] || outside[2] || outside[3]) continue;
        ++needed;
        const uint32_t index = draw.firstIndex + i;
        ASSERT_TRUE(std::ranges::any_of(ranges, [&](const SliceCulling::Range& range) {
          return index >= range.firstIndex && index < range.firstIndex + range.indexCount;
        })) << way;
      }
    }
  }
  EXPECT_GT(needed, all / 50);
  EXPECT_LT(uncut, all);
  EXPECT_LT(drawn - needed,
            (uncut - needed) * 4 / 5);  // a torus is cut in rings, which is not the best of cuts
}

TEST_F(SliceCullingTest, PartsAreOfLargeDrawsOnlyAndEncloseThem) {
  const Scene scene = manyTori();
  const SceneBuffers buffers = createSceneBuffers(device(), scene);
  for (const Draw& draw : buffers.draws) {
    const bool large = draw.indexCount >= kLeastPartedIndices;
    ASSERT_EQ(draw.partCount, large ? (draw.indexCount + kPartIndices - 1) / kPartIndices : 0u);
    const Instance& instance = scene.instances[draw.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (uint32_t i = 0; i < draw.indexCount && large; ++i) {
      const glm::vec3 posW(instance.worldFromMesh * glm::vec4(mesh.positions[mesh.indices[i]], 1.0f));
      const Bounds& part = buffers.partBoundsW[draw.firstPart + i / kPartIndices];
      // Rounding of coordinates of up to 10 m.
      ASSERT_TRUE(glm::all(glm::greaterThan(posW, part.lower - 4e-6f)));
      ASSERT_TRUE(glm::all(glm::lessThan(posW, part.upper + 4e-6f)));
    }
  }
}

}  // namespace
}  // namespace gnomon
