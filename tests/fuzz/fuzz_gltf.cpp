// libFuzzer on the glTF loader: whatever the bytes, a scene or a WorldError of one line; never anything else.
//
//   fuzz_gltf -max_total_time=300 -rss_limit_mb=2048 NEW_INPUTS CORPUS

#include "fuzzer.h"
#include "scene/gltf.h"

#include <cmath>

namespace {

using gnomon::test::require;

// What scene.h promises of any scene.
void checkScene(const gnomon::Scene& scene) {
  require(gnomon::triangleCount(scene) > 0, "it has triangles");
  for (const gnomon::Mesh& mesh : scene.meshes) {
    require((mesh.normals.empty() || mesh.normals.size() == mesh.positions.size()) &&
                mesh.uvs.size() == mesh.positions.size(),
            "sizes agree");
    require(mesh.indices.size() % 3 == 0, "whole triangles");
    require(mesh.material >= 0 && mesh.material < static_cast<int>(scene.materials.size()), "material in range");
    for (uint32_t index : mesh.indices) require(index < mesh.positions.size(), "index in range");
    for (const glm::vec3& normal : mesh.normals) require(std::abs(glm::length(normal) - 1.0f) < 1e-3f, "unit normals");
  }
  for (const gnomon::Instance& instance : scene.instances)
    require(instance.mesh >= 0 && instance.mesh < static_cast<int>(scene.meshes.size()), "mesh in range");
  for (const gnomon::Light& light : scene.lights)
    require(std::abs(glm::length(light.directionW) - 1.0f) < 1e-3f, "unit directions");
  require(std::isfinite(gnomon::computeBounds(scene).diagonal()), "finite bounds");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, size_t size) {
  gnomon::test::readOrRefuse("fuzz.gltf: ", [&] { checkScene(gnomon::loadGltfFromMemory(bytes, size, "fuzz.gltf")); });
  return 0;
}
