#include "base/error.h"
#include "base/terminal.h"
#include "cli/scene_flags.h"
#include "cli/verbs.h"
#include "gpu/device.h"
#include "gpu/shader_compiler.h"
#include "lab/compare/results.h"
#include "scene/adjacency.h"

#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

void printDevices() {
  const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
  say(fmt::format("gnomon {}\n", gnomonVersion()));
  if (devices.empty()) say("no Vulkan device; install one with: apt-get install mesa-vulkan-drivers\n");
  for (const gpu::DeviceInfo& device : devices) {
    say(fmt::format("device {}\n  {}, Vulkan {}, {}\n", device.name, device.isCpu ? "CPU" : "GPU", device.apiVersion,
                    device.driver));
    say(fmt::format("  images to {} texels a side, storage buffers to {} MiB, ordered attachment access: {}\n",
                    device.maxImageDimension2D, device.maxStorageBufferBytes >> 20,
                    device.orderedAttachmentAccess ? "yes" : "no"));
  }
  say(fmt::format("shader cache {}\n", gpu::cacheDirectory().empty() ? "off" : gpu::cacheDirectory().string()));
}

const char* castsAs(const Scene& scene, const Mesh& mesh) {
  if (isSolid(scene, mesh)) return "solid";
  if (scene.materials[mesh.material].doubleSided) return mesh.closed ? "sheet (closed, but doubleSided)" : "sheet";
  return "open (one-sided, but not closed: never culled)";
}

std::string placeText(const glm::dvec3& v) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}

std::string lightText(const Light& light, const glm::dvec3& originW) {
  const std::string place = placeText(glm::dvec3(light.positionW) + originW),
                    towards = placeText(glm::dvec3(light.directionW));
  switch (light.type) {
    case LightType::Point:
      return fmt::format("point at {}, {:g} cd", place, light.intensity);
    case LightType::Spot:
      return fmt::format("spot at {} towards {}, cone {:.4g} degrees, {:g} cd", place, towards,
                         2.0f * glm::degrees(light.outerConeRad), light.intensity);
    case LightType::Directional:
      return fmt::format("directional towards {}, {:g} lx", towards, light.intensity);
  }
  return "";
}

void printScene(const SetupOptions& setup) {
  const Scene scene = openScene(setup);
  const Bounds bounds = computeBounds(scene);
  say(fmt::format("{}: {} triangles, {} meshes, {} instances, {} materials, {} textures\n", scene.name,
                  triangleCount(scene), scene.meshes.size(), scene.instances.size(), scene.materials.size(),
                  scene.textures.size()));
  say(fmt::format("bounds {} to {} m, diagonal {:.4g} m\n", placeText(glm::dvec3(bounds.lower) + scene.originW),
                  placeText(glm::dvec3(bounds.upper) + scene.originW), bounds.diagonal()));
  for (const Mesh& mesh : scene.meshes) {
    const Material& material = scene.materials[mesh.material];
    const Adjacency adjacency = computeAdjacency(mesh.positions, mesh.indices);
    say(fmt::format(
        "mesh '{}': {} triangles, {}{}; {}, {} open edges, {} non-manifold\n", mesh.name, mesh.indices.size() / 3,
        castsAs(scene, mesh), material.alphaMode == AlphaMode::Mask ? ", alpha mask" : "",
        adjacency.sheets == 1 ? "1 connected surface" : fmt::format("{} connected surfaces", adjacency.sheets),
        adjacency.openEdges, adjacency.nonManifoldEdges));
  }
  for (const Light& light : scene.lights)
    say(fmt::format("light '{}': {}\n", light.name, lightText(light, scene.originW)));
  for (const Camera& camera : scene.cameras) {
    say(fmt::format("camera '{}': at {}, fov {:.4g} degrees\n", camera.name,
                    placeText(glm::dvec3(glm::vec3(camera.worldFromEye[3])) + scene.originW),
                    glm::degrees(camera.yFovRad)));
  }
  for (const std::string& note : scene.notes) say(fmt::format("note: {}\n", note));
  for (const std::string& note : scene.harmlessNotes) say(fmt::format("note: {}\n", note));
}

Run addInfo(CLI::App* verb) {
  auto setup = std::make_shared<SetupOptions>();
  addSceneFileFlags(*verb, *setup);
  return [setup] {
    if (setup->scene.empty())
      printDevices();
    else
      printScene(*setup);
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
