#include "base/error.h"
#include "cli/verbs.h"
#include "gpu/device.h"
#include "gpu/shader_compiler.h"
#include "lab/compare/results.h"
#include "scene/adjacency.h"
#include "scene/generate.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

void printDevices() {
  const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
  fmt::print("gnomon {}\n", gnomonVersion());
  if (devices.empty()) fmt::print("no Vulkan device; install one with: apt-get install mesa-vulkan-drivers\n");
  for (const gpu::DeviceInfo& device : devices) {
    fmt::print("device {}\n  {}, Vulkan {}, {}\n", device.name, device.isCpu ? "CPU" : "GPU", device.apiVersion,
               device.driver);
    fmt::print("  images to {} texels a side, storage buffers to {} MiB, ordered attachment access: {}\n",
               device.maxImageDimension2D, device.maxStorageBufferBytes >> 20,
               device.orderedAttachmentAccess ? "yes" : "no");
  }
  fmt::print("shader cache {}\n", gpu::cacheDirectory().empty() ? "off" : gpu::cacheDirectory().string());
}

const char* castsAs(const Scene& scene, const Mesh& mesh) {
  if (isSolid(scene, mesh)) return "solid";
  if (scene.materials[mesh.material].doubleSided) return mesh.closed ? "sheet (closed, but doubleSided)" : "sheet";
  return "open (one-sided, but not closed: never culled)";
}

std::string lightText(const Light& light) {
  const auto text = [](const glm::vec3& v) { return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z); };
  switch (light.type) {
    case LightType::Point:
      return fmt::format("point at {}, {:g} cd", text(light.positionW), light.intensity);
    case LightType::Spot:
      return fmt::format("spot at {} towards {}, cone {:.4g} degrees, {:g} cd", text(light.positionW),
                         text(light.directionW), 2.0f * glm::degrees(light.outerConeRad), light.intensity);
    case LightType::Directional:
      return fmt::format("directional towards {}, {:g} lx", text(light.directionW), light.intensity);
  }
  return "";
}

void printScene(const std::string& name) {
  const Scene scene = openScene(name);
  const Bounds bounds = computeBounds(scene);
  fmt::print("{}: {} triangles, {} meshes, {} instances, {} materials, {} textures\n", scene.name, triangleCount(scene),
             scene.meshes.size(), scene.instances.size(), scene.materials.size(), scene.textures.size());
  fmt::print("bounds {:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g} m, diagonal {:.4g} m\n", bounds.lower.x,
             bounds.lower.y, bounds.lower.z, bounds.upper.x, bounds.upper.y, bounds.upper.z, bounds.diagonal());
  for (const Mesh& mesh : scene.meshes) {
    const Material& material = scene.materials[mesh.material];
    const Adjacency adjacency = computeAdjacency(mesh.positions, mesh.indices);
    fmt::print("mesh '{}': {} triangles, {}{}; {}, {} open edges, {} non-manifold\n", mesh.name,
               mesh.indices.size() / 3, castsAs(scene, mesh),
               material.alphaMode == AlphaMode::Mask ? ", alpha mask" : "",
               adjacency.sheets == 1 ? "1 connected surface" : fmt::format("{} connected surfaces", adjacency.sheets),
               adjacency.openEdges, adjacency.nonManifoldEdges);
  }
  for (const Light& light : scene.lights) fmt::print("light '{}': {}\n", light.name, lightText(light));
  for (const Camera& camera : scene.cameras) {
    const glm::vec4& eye = camera.worldFromEye[3];
    fmt::print("camera '{}': at {:.4g},{:.4g},{:.4g}, fov {:.4g} degrees\n", camera.name, eye.x, eye.y, eye.z,
               glm::degrees(camera.yFovRad));
  }
}

Run addInfo(CLI::App* verb) {
  auto scene = std::make_shared<std::string>();
  verb->add_option("SCENE", *scene, "a glTF file (.gltf, .glb), or a generated scene: `gnomon scene` lists them");
  return [scene] {
    if (scene->empty())
      printDevices();
    else
      printScene(*scene);
    return 0;
  };
}

}  // namespace

Verb infoVerb() {
  return {
      .name = "info",
      .sentence = "shows devices, drivers, versions and limits; for a scene: meshes, solids, sheets, lights, cameras",
      .add = addInfo};
}

}  // namespace gnomon
