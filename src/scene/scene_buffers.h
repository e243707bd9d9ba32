#pragma once
// A scene on the GPU: the tables of shared/scene.glsl, and the list of draws.

#include "gpu/commands.h"
#include "scene/scene.h"

#include "shared/scene.glsl"

#include <vector>

namespace gnomon {

// One instance's triangles. gl_InstanceIndex names the instance, gl_PrimitiveID counts from 0.
struct Draw {
  uint32_t indexCount = 0;
  uint32_t firstIndex = 0;
  uint32_t instance = 0;
  bool masked = false;       // needs the alpha test
  bool doubleSided = false;  // the camera sees both sides
  bool solid = false;        // closed and not doubleSided: its back faces may be culled from a map
  bool mirrored = false;     // the instance's matrix turns the winding round
  Bounds boundsW;            // metres
};

struct SceneBuffers {
  gpu::Buffer positions, triangles, instances, uvs, materials, textures, texels, normals;
  std::vector<Draw> draws;               // opaque first
  std::vector<uint32_t> firstTriangles;  // one an instance, in the array of triangles
  bool instanced = false;                // some matrix is not the identity
};

SceneBuffers createSceneBuffers(const gpu::Device& device, const Scene& scene);

// Records the draws for which `wanted` holds; the program is already bound.
template <typename Predicate>
void recordDraws(gpu::Commands& commands, const SceneBuffers& scene, Predicate wanted) {
  for (const Draw& draw : scene.draws)
    if (wanted(draw)) commands.drawIndexed(draw.indexCount, 1, draw.firstIndex, 0, draw.instance);
}

}  // namespace gnomon
