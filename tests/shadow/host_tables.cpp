#include "host_tables.h"

namespace gnomon::test {

namespace {

bool isHole(const void* scene, uint32_t triangle, uint32_t instance, glm::vec3 weights) {
  const Scene& all = *static_cast<const Scene*>(scene);
  size_t first = 0;
  for (size_t m = 0; m < all.meshes.size(); ++m) {
    const Mesh& mesh = all.meshes[m];
    if (triangle - first >= mesh.indices.size() / 3) {
      first += mesh.indices.size() / 3;
      continue;
    }
    const Material& material = all.materials[static_cast<size_t>(mesh.material)];
    if (material.alphaMode != AlphaMode::Mask) return false;
    const uint32_t* v = &mesh.indices[3 * (triangle - first)];
    const glm::vec2 uv = mesh.uvs[v[0]] * weights.x + mesh.uvs[v[1]] * weights.y + mesh.uvs[v[2]] * weights.z;
    return baseColorAt(all, material, uv).w < material.alphaCutoff;
  }
  return instance != 0;  // no such triangle
}

}  // namespace

HostTables::HostTables(const Scene& scene, const SceneBuffers& buffers, const FittedMap& fitted,
                       std::vector<uint32_t> ids, std::vector<float> depths)
    : buffers_(buffers),
      fitted_(fitted),
      links_(linkMeshes(scene, buffers.instanced)),
      ids_(std::move(ids)),
      depths_(std::move(depths)),
      masked_(buffers.masked) {
  for (size_t i = 0; i < scene.instances.size(); ++i)
    instances_.push_back({.worldFromMesh = scene.instances[i].worldFromMesh,
                          .firstTriangle = buffers.firstTriangles[i],
                          .material = 0,
                          .firstId = buffers.ids.firstIds[i]});
  host_ = {.rows = links_.rows.data(),
           .instances = instances_.data(),
           .chunks = buffers.ids.chunks.data(),
           .facts = links_.facts.data(),
           .ids = ids_.data(),
           .depths = depths_.data(),
           .isHole = isHole,
           .scene = &scene};
}

glsl::LookupTables HostTables::tables() const {
  return {.frame = fitted_.frame,
          .positional = fitted_.positional ? 1.0f : 0.0f,
          .endMargin = buffers_.endMargin,
          .instanced = buffers_.instanced ? 1 : 0,
          .idShift = buffers_.ids.shift,
          .masked = masked_ ? 1 : 0,
          .mapWidth = fitted_.map.width,
          .mapHeight = fitted_.map.height,
          .host = &host_};
}

}  // namespace gnomon::test
