#pragma once
// Input of the non-linear rasterizer. A compute shader of the parameterization culls the triangles that a slice does
// not show and bounds the projections of the others (shared/bounded_triangle.glsl); one indirect draw follows.
// Triangles go in batches, so that a scene of any size takes the same memory.

#include "scene/scene_buffers.h"
#include "shadow/slice_shaders.h"

#include "shared/bounded_triangle.glsl"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

class BoundedDraws {
 public:
  explicit BoundedDraws(const gpu::Device& device) : device_(device) {}

  // Some triangles of one instance, by their numbers in the array of all triangles.
  struct Piece {
    uint32_t firstTriangle = 0;
    uint32_t triangleCount = 0;
    uint32_t instance = 0;
    uint32_t firstId = 0;  // of firstTriangle (scene/triangle_ids.h)
    int facing = 0;        // 1: only what winds counter-clockwise seen from the light, -1: only the rest, 0: both
  };
  using Batch = std::vector<Piece>;
  static constexpr uint32_t kBatchTriangles = 1u << 18;  // 53 MiB with what they may be cut into
  static std::vector<Batch> batches(const std::vector<Piece>& pieces);

  // Makes and compiles all that record() needs of so many triangles, all instances' together.
  void prepare(const SliceShaders& shaders, uint64_t triangles);

  // Makes the list of one batch for a slice; a draw may read it after.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const gpu::Buffer& mapUniforms,
              const SliceShaders& shaders, int slice, const Batch& batch);

  const gpu::Buffer& triangles() const { return triangles_; }
  const gpu::Buffer& arguments() const { return arguments_; }

 private:
  struct Entry {
    std::string shader;
    gpu::ComputeProgram program;
  };
  const gpu::ComputeProgram& program(const std::string& shader);
  void makeRoom(uint64_t triangles);

  const gpu::Device& device_;
  gpu::Buffer triangles_, large_, arguments_, noArguments_;  // made at the first use
  uint64_t room_ = 0;                                        // triangles of a batch that they hold
  std::vector<std::unique_ptr<Entry>> programs_;
};

}  // namespace gnomon
