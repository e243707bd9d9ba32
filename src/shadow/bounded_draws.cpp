#include "shadow/bounded_draws.h"

#include "base/check.h"

#include "shared/map.glsl"

#include <algorithm>

namespace gnomon {

namespace {

// As the compute shaders declare it.
struct BoundPush {
  int32_t slice;
  int32_t facing;
  uint32_t firstTriangle, triangleCount, instance, firstId;
};

}  // namespace

std::vector<BoundedDraws::Batch> BoundedDraws::batches(const std::vector<Piece>& pieces) {
  std::vector<Batch> batches;
  uint32_t room = 0;
  for (Piece rest : pieces) {
    while (rest.triangleCount > 0) {
      if (room == 0) {
        batches.emplace_back();
        room = kBatchTriangles;
      }
      Piece piece = rest;
      piece.triangleCount = std::min(rest.triangleCount, room);
      batches.back().push_back(piece);
      room -= piece.triangleCount;
      rest.firstTriangle += piece.triangleCount;
      rest.firstId += piece.triangleCount;
      rest.triangleCount -= piece.triangleCount;
    }
  }
  return batches;
}

const gpu::ComputeProgram& BoundedDraws::program(const std::string& shader) {
  for (const auto& entry : programs_)
    if (entry->shader == shader) return entry->program;
  programs_.push_back(
      std::make_unique<Entry>(Entry{shader, gpu::ComputeProgram(device_, gpu::ShaderSource{shader, {}})}));
  return programs_.back()->program;
}

void BoundedDraws::makeRoom(uint64_t triangles) {
  if (room_ > 0) return;
  room_ = std::clamp<uint64_t>(triangles, 1, kBatchTriangles);
  const VkDeviceSize most = room_ + glsl::kMostExtraTriangles;
  triangles_ = gpu::Buffer(device_, {.name = "bounded triangles", .size = most * sizeof(glsl::BoundedTriangle)});
  large_ = gpu::Buffer(device_, {.name = "large triangles", .size = room_ * sizeof(glsl::LargeTriangle)});
  arguments_ =
      gpu::Buffer(device_, {.name = "bounded draw",
                            .size = sizeof(glsl::BoundedDraw) + 2 * most * sizeof(uint32_t),
                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT});
  noArguments_ = gpu::createBufferWith(device_, "no bounded draw",
                                       std::vector<glsl::BoundedDraw>{{.instanceCount = 1, .one = 1, .oneMore = 1}});
}

void BoundedDraws::prepare(const SliceShaders& shaders, uint64_t triangles) {
  makeRoom(triangles);
  program(shaders.bounds);
  if (*shaders.largeBounds != '\0') program(shaders.largeBounds);
}

void BoundedDraws::record(gpu::Commands& commands, const SceneBuffers& scene, const gpu::Buffer& mapUniforms,
                          const SliceShaders& shaders, int slice, const Batch& batch) {
  makeRoom(kBatchTriangles);
  uint64_t triangles = 0;
  for (const Piece& piece : batch) triangles += piece.triangleCount;
  GNOMON_CHECK_LE(triangles, room_);
  const auto bindingsOf = [&](const gpu::ComputeProgram& found) {
    return gpu::declaredBy(found, {{glsl::kBindPositions, scene.positions},
                                   {glsl::kBindTriangles, scene.triangles},
                                   {glsl::kBindInstances, scene.instances},
                                   {glsl::kBindUvs, scene.uvs},
                                   {glsl::kBindMap, mapUniforms},
                                   {glsl::kBindBoundedTriangles, triangles_},
                                   {glsl::kBindBoundedDraw, arguments_},
                                   {glsl::kBindLargeTriangles, large_}});
  };
  commands.copy(noArguments_, arguments_, sizeof(glsl::BoundedDraw));
  commands.barrier("the count is zero -> triangles are counted");
  const gpu::ComputeProgram& bounds = program(shaders.bounds);
  for (const Piece& piece : batch) {
    const BoundPush push{slice, piece.facing, piece.firstTriangle, piece.triangleCount, piece.instance, piece.firstId};
    const uint32_t groups = (piece.triangleCount + glsl::kBoundGroupSize - 1) / glsl::kBoundGroupSize;
    commands.dispatch(bounds, {groups, 1, 1}, gpu::asPush(push), bindingsOf(bounds));
  }
  if (*shaders.largeBounds != '\0') {
    commands.barrier("large triangles are listed and counted -> they are bounded");
    const gpu::ComputeProgram& large = program(shaders.largeBounds);
    const int32_t push = slice;
    commands.dispatchIndirect(large, arguments_, offsetof(glsl::BoundedDraw, largeGroups), gpu::asPush(push),
                              bindingsOf(large));
  }
  commands.barrier("triangles and their count are written -> the draw reads them");
}

}  // namespace gnomon
