#include "scene/gltf.h"

#include "base/error.h"
#include "base/file.h"
#include "scene/gltf_document.h"
#include "scene/gltf_material.h"
#include "scene/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <new>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/quaternion.hpp>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

constexpr double kFarthest = 1e7;  // metres; beyond, floats are a metre apart
constexpr uint64_t kMaxInstances = 1'000'000;
constexpr uint64_t kMaxTriangles = uint64_t{1} << 31;  // of all instances

struct PlacedNode {
  int node = 0;
  glm::dmat4 worldFromNode{1.0};
};

glm::dmat4 localMatrix(const GltfDocument& document, int index) {
  const tinygltf::Node& node = document.model().nodes[index];
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) matrix[c][r] = node.matrix[4 * c + r];
    if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0)
      document.refuse(fmt::format("node {} has a matrix that is not affine", index), kRemedy);
    return matrix;
  }
  if (node.rotation.size() == 4) {
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double size = glm::length(rotation);
    if (!(size > 1e-6 && size < 1e6))
      document.refuse(fmt::format("node {} has a rotation of length {}", index, size), kRemedy);
    matrix = glm::mat4_cast(rotation / size);
  }
  for (int c = 0; c < 3 && node.scale.size() == 3; ++c) matrix[c] *= node.scale[c];
  for (int r = 0; r < 3 && node.translation.size() == 3; ++r) matrix[3][r] = node.translation[r];
  return matrix;
}

bool isFinite(const glm::dmat4& matrix) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(matrix[c][r])) return false;
  return true;
}

// The roots of the scene that the file shows. Every node has one parent at most, and none is its own
// ancestor.
std::vector<int> sceneRoots(const GltfDocument& document) {
  const tinygltf::Model& model = document.model();
  std::vector<int> parent(model.nodes.size(), -1);
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    for (int child : model.nodes[i].children) {
      if (parent[child] >= 0)
        document.refuse(
            fmt::format("node {} is a child of both node {} and node {}", child, parent[child], i), kRemedy);
      parent[child] = static_cast<int>(i);
    }
  }
  // Whatever cannot be reached from a node without parent goes round in a circle.
  std::vector<int> open, roots;
  for (size_t i = 0; i < parent.size(); ++i)
    if (parent[i] < 0) roots.push_back(static_cast<int>(i));
  open = roots;
  std::vector<bool> reached(model.nodes.size(), false);
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    reached[node] = true;
    open.insert(open.end(), model.nodes[node].children.begin(), model.nodes[node].children.end());
  }
  const auto circle = std::find(reached.begin(), reached.end(), false);
  if (circle != reached.end())
    document.refuse(fmt::format("node {} is its own ancestor", circle - reached.begin()), kRemedy);
  if (model.scenes.empty()) return roots;
  roots = model.scenes[std::max(model.defaultScene, 0)].nodes;
  std::vector<bool> listed(model.nodes.size(), false);
  for (int root : roots) {
    if (parent[root] >= 0)
      document.refuse(
          fmt::format("node {} is a root of the scene and a child of node {}", root, parent[root]), kRemedy);
    if (listed[root]) document.refuse(fmt::format("node {} is listed twice in the scene", root), kRemedy);
    listed[root] = true;
  }
  return roots;
}

// All nodes of the scene with their transforms, parents before children, in the file's order.
std::vector<PlacedNode> placeNodes(const GltfDocument& document) {
  std::vector<PlacedNode> placed, open;
  const std::vector<int> roots = sceneRoots(document);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) open.push_back({*it, localMatrix(document, *it)});
  while (!open.empty()) {
    const PlacedNode current = open.back();
    open.pop_back();
    if (!isFinite(current.worldFromNode))
      document.refuse(fmt::format("node {} is placed at infinity", current.node), kRemedy);
    placed.push_back(current);
    const std::vector<int>& children = document.model().nodes[current.node].children;
    for (auto it = children.rbegin(); it != children.rend(); ++it)
      open.push_back({*it, current.worldFromNode * localMatrix(document, *it)});
  }
  return placed;
}

bool isZero(double value) {
  return value == 0.0;
}

// What a node says of its mesh that Gnomon does not do.
void checkMeshNode(const GltfDocument& document, int index) {
  const tinygltf::Node& node = document.model().nodes[index];
  const std::vector<double>& meshWeights = document.model().meshes[node.mesh].weights;
  const std::vector<double>& weights = node.weights.empty() ? meshWeights : node.weights;
  if (node.skin >= 0)
    document.refuse(fmt::format("node {} is skinned, which Gnomon does not read", index),
                    "apply the pose before exporting");
  if (!std::all_of(weights.begin(), weights.end(), isZero))
    document.refuse(fmt::format("node {} is morphed, which Gnomon does not read", index),
                    "apply the shape before exporting");
  if (node.extensions.contains("EXT_mesh_gpu_instancing"))
    document.refuse(fmt::format("node {} uses EXT_mesh_gpu_instancing, which Gnomon does not read", index),
                    "expand the instances to nodes before exporting");
}

// Matrices that squash a mesh flat have no inverse; their instances are baked, so that nobody has to invert
// them.
bool isInvertible(const glm::dmat4& matrix) {
  const double determinant = glm::determinant(glm::dmat3(matrix));
  return std::isfinite(determinant) && std::abs(determinant) > 1e-18;
}

// Applies the transform in double. A mirror turns every triangle over, so its winding is turned back.
void bake(Mesh& mesh, const glm::dmat4& worldFromMesh) {
  if (worldFromMesh == glm::dmat4(1.0)) return;
  const glm::dmat3 linear(worldFromMesh);
  // The cofactor matrix is the inverse transpose times the determinant, and exists for flat transforms too.
  const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
  const double sign = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  for (glm::vec3& position : mesh.positions)
    position = glm::vec3(glm::dvec3(worldFromMesh * glm::dvec4(glm::dvec3(position), 1.0)));
  for (glm::vec3& normal : mesh.normals) {
    const glm::dvec3 turned = sign * (cofactor * glm::dvec3(normal));
    const double size = glm::length(turned);
    normal = size > 0.0 && std::isfinite(size) ? glm::vec3(turned / size) : glm::vec3(0.0f, 1.0f, 0.0f);
  }
  if (sign < 0.0)
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

void checkNear(const GltfDocument& document, const glm::dvec3& point, int node) {
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(point[c]) <= kFarthest))
      document.refuse(fmt::format("node {} reaches beyond {} m from the origin", node, kFarthest),
                      "scale or move the scene: glTF's unit is the metre");
}

// Turns the nodes' meshes into the scene's meshes and instances. A mesh that one node uses is baked; those
// that several use keep their matrices, but for nodes whose matrix has no inverse, which get a baked copy.
class GeometryLoader {
 public:
  GeometryLoader(GltfDocument& document, Scene& scene, std::vector<UvSource> uvSources)
      : document_(document), scene_(scene), uvSources_(std::move(uvSources)) {}

  void load(const std::vector<PlacedNode>& nodes) {
    countUses(nodes);
    const std::vector<tinygltf::Mesh>& meshes = document_.model().meshes;
    parts_.resize(meshes.size());
    for (size_t i = 0; i < meshes.size(); ++i)
      if (uses_[i].all > 0) loadParts(static_cast<int>(i));
    checkTriangles(nodes);
    for (const PlacedNode& placed : nodes)
      if (document_.model().nodes[placed.node].mesh >= 0) addInstances(placed);
    for (Mesh& mesh : scene_.meshes) mesh.closed = computeClosed(mesh);
  }

 private:
  struct Uses {
    uint64_t all = 0;
    uint64_t invertible = 0;
    uint64_t done = 0;
  };
  // A primitive as it lies in the scene, and its bounds before any baking.
  struct Part {
    int mesh = 0;
    glm::dvec3 lower{0.0}, upper{0.0};
  };

  void countUses(const std::vector<PlacedNode>& nodes) {
    const tinygltf::Model& model = document_.model();
    uses_.resize(model.meshes.size());
    uint64_t instances = 0;
    for (const PlacedNode& placed : nodes) {
      const int mesh = model.nodes[placed.node].mesh;
      if (mesh < 0) continue;
      checkMeshNode(document_, placed.node);
      ++uses_[mesh].all;
      if (isInvertible(placed.worldFromNode)) ++uses_[mesh].invertible;
      instances += model.meshes[mesh].primitives.size();
    }
    if (instances > kMaxInstances)
      document_.refuse(fmt::format("has {} instances, more than {}", instances, kMaxInstances),
                       "merge meshes");
  }

  void loadParts(int index) {
    const tinygltf::Mesh& source = document_.model().meshes[index];
    const std::string name = source.name.empty() ? fmt::format("mesh {}", index) : source.name;
    for (size_t k = 0; k < source.primitives.size(); ++k) {
      const int material = source.primitives[k].material;
      const UvSource uvSource = material < 0 ? UvSource{} : uvSources_[material];
      std::optional<Mesh> mesh = loadPrimitive(document_, source.primitives[k], uvSource,
                                               fmt::format("mesh {}, primitive {}", index, k));
      if (!mesh || mesh->indices.empty()) continue;
      mesh->name = source.primitives.size() == 1 ? name : fmt::format("{} {}", name, k);
      mesh->material = material < 0 ? defaultMaterial() : material;
      Part part;
      part.mesh = static_cast<int>(scene_.meshes.size());
      part.lower = part.upper = glm::dvec3(mesh->positions[0]);
      for (const glm::vec3& position : mesh->positions) {
        part.lower = glm::min(part.lower, glm::dvec3(position));
        part.upper = glm::max(part.upper, glm::dvec3(position));
      }
      parts_[index].push_back(part);
      scene_.meshes.push_back(std::move(*mesh));
    }
  }

  // glTF's own: white, opaque, single-sided. Added only to a scene that needs it.
  int defaultMaterial() {
    if (defaultMaterial_ < 0) {
      defaultMaterial_ = static_cast<int>(scene_.materials.size());
      scene_.materials.emplace_back().name = "default";
    }
    return defaultMaterial_;
  }

  void checkTriangles(const std::vector<PlacedNode>& nodes) const {
    uint64_t triangles = 0;
    for (const PlacedNode& placed : nodes) {
      const int mesh = document_.model().nodes[placed.node].mesh;
      if (mesh < 0) continue;
      for (const Part& part : parts_[mesh]) triangles += scene_.meshes[part.mesh].indices.size() / 3;
    }
    if (triangles == 0)
      document_.refuse("has no triangles in its scene", "name a file with meshes of triangles");
    if (triangles > kMaxTriangles)
      document_.refuse(fmt::format("has {} triangles, more than 2^31", triangles), "split the scene");
  }

  void addInstances(const PlacedNode& placed) {
    const tinygltf::Node& node = document_.model().nodes[placed.node];
    Uses& uses = uses_[node.mesh];
    ++uses.done;
    const bool shared = uses.all > 1 && isInvertible(placed.worldFromNode);
    // Nobody else needs the mesh as it is in the file.
    const bool inPlace = uses.all == 1 || (uses.invertible == 0 && uses.done == uses.all);
    for (const Part& part : parts_[node.mesh]) {
      checkBounds(part, placed);
      Instance instance;
      instance.mesh = part.mesh;
      instance.name = node.name.empty() ? scene_.meshes[part.mesh].name : node.name;
      if (shared) {
        instance.worldFromMesh = glm::mat4(placed.worldFromNode);
      } else {
        if (!inPlace) instance.mesh = copyMesh(part.mesh);
        bake(scene_.meshes[instance.mesh], placed.worldFromNode);
      }
      scene_.instances.push_back(std::move(instance));
    }
  }

  int copyMesh(int mesh) {
    const Mesh& source = scene_.meshes[mesh];
    document_.spend(source.positions.size() * (2 * sizeof(glm::vec3) + sizeof(glm::vec2)) +
                    source.indices.size() * sizeof(uint32_t));
    Mesh copy = source;
    scene_.meshes.push_back(std::move(copy));
    return static_cast<int>(scene_.meshes.size()) - 1;
  }

  // The corners of the mesh's own bounds, placed, enclose all of its vertices.
  void checkBounds(const Part& part, const PlacedNode& placed) const {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 point(corner & 1 ? part.upper.x : part.lower.x,
                             corner & 2 ? part.upper.y : part.lower.y,
                             corner & 4 ? part.upper.z : part.lower.z);
      checkNear(document_, glm::dvec3(placed.worldFromNode * glm::dvec4(point, 1.0)), placed.node);
    }
  }

  GltfDocument& document_;
  Scene& scene_;
  std::vector<UvSource> uvSources_;
  std::vector<Uses> uses_;                // of each glTF mesh, by nodes of the scene
  std::vector<std::vector<Part>> parts_;  // of each glTF mesh
  int defaultMaterial_ = -1;
};

// A node's -z in the world, or +y and so on by axis; unit vectors stay as they are to the last bit.
glm::vec3 unitColumn(const GltfDocument& document, const PlacedNode& placed, int column, double sign) {
  const glm::dvec3 axis = sign * glm::dvec3(placed.worldFromNode[column]);
  const double size = glm::length(axis);
  if (!(size > 1e-12) || !std::isfinite(size))
    document.refuse(fmt::format("node {} has no direction: its scale is zero", placed.node), kRemedy);
  return glm::vec3(std::abs(size - 1.0) < 1e-6 ? axis : axis / size);
}

float finiteFloat(const GltfDocument& document, double value, const std::string& what) {
  if (!(value >= 0.0 && value <= 1e30))
    document.refuse(fmt::format("{} is {}", what, value), "use a number from 0 up");
  return static_cast<float>(value);
}

Light lightOf(const GltfDocument& document, const PlacedNode& placed, int index) {
  const tinygltf::Model& model = document.model();
  if (index < 0 || index >= static_cast<int>(model.lights.size()))
    document.refuse(
        fmt::format("node {}: light {} is not among the file's {}", placed.node, index, model.lights.size()),
        kRemedy);
  const tinygltf::Light& source = model.lights[index];
  const std::string& nodeName = model.nodes[placed.node].name;
  Light light;
  light.name = !nodeName.empty()      ? nodeName
               : !source.name.empty() ? source.name
                                      : fmt::format("light {}", index);
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
    const glm::dvec3 position(placed.worldFromNode[3]);
    checkNear(document, position, placed.node);
    light.positionW = glm::vec3(position);
  }
  if (light.type != LightType::Point) light.directionW = unitColumn(document, placed, 2, -1.0);
  if (light.type == LightType::Spot) {
    light.innerConeRad =
        finiteFloat(document, source.spot.innerConeAngle, fmt::format("light {}: innerConeAngle", index));
    light.outerConeRad =
        finiteFloat(document, source.spot.outerConeAngle, fmt::format("light {}: outerConeAngle", index));
    // A whisker above pi/2, for exporters that round up.
    if (light.outerConeRad <= 0.0f || light.outerConeRad > 1.5708f || light.innerConeRad > light.outerConeRad)
      document.refuse(
          fmt::format("light {} has cone angles {} and {}", index, light.innerConeRad, light.outerConeRad),
          "use 0 <= inner < outer <= pi/2");
  }
  return light;
}

// Rigid: scale and shear of the node are taken off. A matrix that is rigid already stays as it is.
glm::mat4 rigidMatrix(const GltfDocument& document, const PlacedNode& placed) {
  const glm::dmat3 linear(placed.worldFromNode);
  const glm::dmat3 excess = glm::transpose(linear) * linear - glm::dmat3(1.0);
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, glm::length(excess[c]));
  if (worst < 1e-5 && glm::determinant(linear) > 0.0) return glm::mat4(placed.worldFromNode);
  const glm::dvec3 back(unitColumn(document, placed, 2, 1.0)), up(unitColumn(document, placed, 1, 1.0));
  const glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 1e-6))
    document.refuse(fmt::format("node {} is a camera without an upright", placed.node), kRemedy);
  const glm::dvec3 x = glm::normalize(right), z = glm::normalize(back);
  return glm::mat4(glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0),
                              placed.worldFromNode[3]));
}

// Nothing for an orthographic camera: Gnomon's are perspective.
std::optional<Camera> cameraOf(const GltfDocument& document, const PlacedNode& placed) {
  const tinygltf::Node& node = document.model().nodes[placed.node];
  const tinygltf::Camera& source = document.model().cameras[node.camera];
  if (source.type != "perspective") return std::nullopt;
  Camera camera;
  camera.name = !node.name.empty()     ? node.name
                : !source.name.empty() ? source.name
                                       : fmt::format("camera {}", node.camera);
  const double yFov = source.perspective.yfov, zNear = source.perspective.znear;
  if (!(yFov > 1e-4 && yFov < 3.1415))
    document.refuse(fmt::format("camera {} has yfov {}", node.camera, yFov), "use 0 < yfov < pi");
  if (!(zNear > 1e-12 && zNear < kFarthest))
    document.refuse(fmt::format("camera {} has znear {}", node.camera, zNear),
                    "use a positive distance in metres");
  checkNear(document, glm::dvec3(placed.worldFromNode[3]), placed.node);
  camera.worldFromEye = rigidMatrix(document, placed);
  camera.yFovRad = static_cast<float>(yFov);
  camera.zNear = static_cast<float>(zNear);
  return camera;
}

void loadLightsAndCameras(const GltfDocument& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = document.model().nodes[placed.node];
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end())
      scene.lights.push_back(lightOf(document, placed, light->second.Get("light").GetNumberAsInt()));
    if (node.camera < 0) continue;
    if (std::optional<Camera> camera = cameraOf(document, placed))
      scene.cameras.push_back(std::move(*camera));
  }
}

Scene sceneOf(GltfDocument& document) {
  Scene scene;
  scene.name = std::filesystem::path(document.name()).stem().string();
  std::vector<UvSource> uvSources = loadMaterials(document, scene);
  const std::vector<PlacedNode> nodes = placeNodes(document);
  GeometryLoader(document, scene, std::move(uvSources)).load(nodes);
  loadLightsAndCameras(document, nodes, scene);
  return scene;
}

// tinygltf and the standard library throw what they like; a person gets one line about the file.
Scene loadBytes(std::string_view bytes, const std::string& name, const std::filesystem::path& folder) {
  try {
    GltfDocument document(bytes, name, folder);
    return sceneOf(document);
  } catch (const WorldError& error) {
    const std::string_view message = error.what();
    // The name may be long, so only what follows it is cut to one line.
    const bool named = message.starts_with(name);
    throw WorldError((named ? name : "") + oneLine(message.substr(named ? name.size() : 0)));
  } catch (const std::bad_alloc&) {
    throw fileError(name, "needs more memory than there is", "use a smaller scene");
  } catch (const std::exception& error) {
    throw fileError(name, "cannot be read as glTF: " + oneLine(error.what()), kRemedy);
  }
}

}  // namespace

Scene loadGltf(const std::filesystem::path& path) {
  const std::string bytes = readFile(path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return loadBytes(bytes, path.string(), folder);
}

Scene loadGltfFromMemory(const unsigned char* bytes, size_t size, const std::string& name) {
  return loadBytes({reinterpret_cast<const char*>(bytes), size}, name, {});
}

}  // namespace gnomon
