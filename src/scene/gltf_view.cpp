#include "scene/gltf_view.h"

#include "base/message.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

constexpr double kFarthestNear = 1e7;  // metres; a near plane beyond is a mistake

// A node's -z in the world, or +y and so on by axis; unit vectors stay as they are to the last bit.
glm::vec3 unitColumn(const GltfDocument& document, const PlacedNode& placed, int column, double sign) {
  const glm::dvec3 axis = sign * glm::dvec3(placed.worldFromNode[column]);
  const double size = glm::length(axis);
  if (!(size > 1e-12) || !std::isfinite(size))
    document.refuse(fmt::format("node {} has no direction: its scale is zero", placed.node), kRemedy);
  return glm::vec3(std::abs(size - 1.0) < 1e-6 ? axis : axis / size);
}

float finiteFloat(const GltfDocument& document, double value, const std::string& what) {
  if (!(value >= 0.0 && value <= 1e30)) document.refuse(fmt::format("{} is {}", what, value), "use a number from 0 up");
  return static_cast<float>(value);
}

Light lightOf(GltfDocument& document, const PlacedNode& placed, int index, const glm::dvec3& originW) {
  const tinygltf::Model& model = document.model();
  if (index < 0 || index >= static_cast<int>(model.lights.size()))
    document.refuse(
        fmt::format("node {}: light {} is not among the file's {}", placed.node, index, model.lights.size()), kRemedy);
  const tinygltf::Light& source = model.lights[index];
  const std::string& nodeName = model.nodes[placed.node].name;
  Light light;
  light.name = printable(!nodeName.empty()      ? nodeName
                         : !source.name.empty() ? source.name
                                                : fmt::format("light {}", index));
  if (source.type != "point" && source.type != "spot" && source.type != "directional")
    document.refuse(fmt::format("light {} has the unknown type '{}'", index, oneLine(source.type)),
                    "use point, spot or directional");
  light.type = source.type == "point"  ? LightType::Point
               : source.type == "spot" ? LightType::Spot
                                       : LightType::Directional;
  light.intensity = finiteFloat(document, source.intensity, fmt::format("light {}: intensity", index));
  for (int c = 0; c < 3 && source.color.size() == 3; ++c)
    light.color[c] = finiteFloat(document, source.color[c], fmt::format("light {}: color", index));
  if (light.type != LightType::Directional) {
    const glm::dvec3 position = glm::dvec3(placed.worldFromNode[3]) - originW;
    checkNear(document, position, placed.node);
    light.positionW = glm::vec3(position);
  }
  if (source.range > 0.0)
    document.notes.push_back(
        fmt::format("light '{}' ends at {:g} m in the file, but reaches on here", oneLine(light.name), source.range));
  if (light.type != LightType::Point) light.directionW = unitColumn(document, placed, 2, -1.0);
  if (light.type == LightType::Spot) {
    light.innerConeRad =
        finiteFloat(document, source.spot.innerConeAngle, fmt::format("light {}: innerConeAngle", index));
    light.outerConeRad =
        finiteFloat(document, source.spot.outerConeAngle, fmt::format("light {}: outerConeAngle", index));
    // A whisker above pi/2, for exporters that round up.
    if (light.outerConeRad <= 0.0f || light.outerConeRad > 1.5708f || light.innerConeRad > light.outerConeRad)
      document.refuse(fmt::format("light {} has cone angles {} and {}", index, light.innerConeRad, light.outerConeRad),
                      "use 0 <= inner < outer <= pi/2");
  }
  return light;
}

// Rigid: scale and shear of the node are taken off. A matrix that is rigid already stays as it is.
glm::mat4 rigidMatrix(const GltfDocument& document, const PlacedNode& placed, const glm::dvec3& originW) {
  const glm::dvec4 eye(glm::dvec3(placed.worldFromNode[3]) - originW, 1.0);
  const glm::dmat3 linear(placed.worldFromNode);
  const glm::dmat3 excess = glm::transpose(linear) * linear - glm::dmat3(1.0);
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, glm::length(excess[c]));
  if (worst < 1e-5 && glm::determinant(linear) > 0.0)
    return glm::mat4(glm::dmat4(placed.worldFromNode[0], placed.worldFromNode[1], placed.worldFromNode[2], eye));
  const glm::dvec3 back(unitColumn(document, placed, 2, 1.0)), up(unitColumn(document, placed, 1, 1.0));
  const glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 1e-6))
    document.refuse(fmt::format("node {} is a camera without an upright", placed.node), kRemedy);
  const glm::dvec3 x = glm::normalize(right), z = glm::normalize(back);
  return glm::mat4(glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0), eye));
}

// Nothing for an orthographic camera: Gnomon's are perspective.
std::optional<Camera> cameraOf(GltfDocument& document, const PlacedNode& placed, const glm::dvec3& originW) {
  const tinygltf::Node& node = document.model().nodes[placed.node];
  const tinygltf::Camera& source = document.model().cameras[node.camera];
  if (source.type != "perspective") {
    document.notes.push_back(fmt::format("camera {} '{}' is {}, which Gnomon does not draw; it is passed over",
                                         node.camera, oneLine(node.name.empty() ? source.name : node.name),
                                         oneLine(source.type)));
    return std::nullopt;
  }
  Camera camera;
  camera.name = printable(!node.name.empty()     ? node.name
                          : !source.name.empty() ? source.name
                                                 : fmt::format("camera {}", node.camera));
  const double yFov = source.perspective.yfov, zNear = source.perspective.znear;
  if (!(yFov > 1e-4 && yFov < 3.1415))
    document.refuse(fmt::format("camera {} has yfov {}", node.camera, yFov), "use 0 < yfov < pi");
  if (!(zNear > 1e-12 && zNear < kFarthestNear))
    document.refuse(fmt::format("camera {} has znear {}", node.camera, zNear), "use a positive distance in metres");
  checkNear(document, glm::dvec3(placed.worldFromNode[3]) - originW, placed.node);
  camera.worldFromEye = rigidMatrix(document, placed, originW);
  camera.yFovRad = static_cast<float>(yFov);
  camera.zNear = static_cast<float>(zNear);
  camera.aspect = std::isfinite(source.perspective.aspectRatio) ? std::max(source.perspective.aspectRatio, 0.0) : 0.0;
  return camera;
}

// Names are how a person asks for one. Where several have the same, a path that only one has takes its place, else its
// number joins: "lamp", "lamp #3".
template <typename T>
void makeNamesDiffer(std::vector<T>& things) {
  std::map<std::string, int> names, paths;
  for (const T& thing : things) {
    ++names[thing.name];
    ++paths[thing.path];
  }
  std::set<std::string> taken;
  for (size_t i = 0; i < things.size(); ++i) {
    T& thing = things[i];
    if (names[thing.name] > 1 && paths[thing.path] == 1 && !thing.path.empty()) thing.name = thing.path;
    while (!taken.insert(thing.name).second) thing.name += fmt::format(" #{}", i);
  }
}

}  // namespace

void loadLightsAndCameras(GltfDocument& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = document.model().nodes[placed.node];
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end() && placed.visible) {
      scene.lights.push_back(lightOf(document, placed, light->second.Get("light").GetNumberAsInt(), scene.originW));
      scene.lights.back().path = pathOf(document, nodes, placed);
    }
    if (node.camera < 0) continue;
    if (std::optional<Camera> camera = cameraOf(document, placed, scene.originW)) {
      camera->path = pathOf(document, nodes, placed);
      scene.cameras.push_back(std::move(*camera));
    }
  }
  makeNamesDiffer(scene.lights);
  makeNamesDiffer(scene.cameras);
}

}  // namespace gnomon
