#pragma once
// The tables of shared/lookup_tables.glsl in host memory, of a scene, a fitted map and what it holds.

#include "scene/mesh_links.h"
#include "scene/scene_buffers.h"
#include "shadow/parameterization.h"

#include "shared/lookup_tables.glsl"

#include <vector>

namespace gnomon::test {

// Stays where it is made.
class HostTables {
 public:
  HostTables(const Scene& scene, const SceneBuffers& buffers, const FittedMap& fitted, std::vector<uint32_t> ids,
             std::vector<float> depths);
  HostTables(const HostTables&) = delete;
  HostTables& operator=(const HostTables&) = delete;

  glsl::LookupTables tables() const;

 private:
  const SceneBuffers& buffers_;
  const FittedMap& fitted_;
  MeshLinks links_;
  std::vector<glsl::SceneInstance> instances_;
  std::vector<uint32_t> ids_;
  std::vector<float> depths_;
  glsl::HostTables host_{};
  const bool masked_;
};

}  // namespace gnomon::test
