#include "scene/gltf.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_document.h"
#include "scene/gltf_material.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_primitive.h"
#include "scene/gltf_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/quaternion.hpp>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

constexpr uint64_t kMaxInstances = 1'000'000;
constexpr uint64_t kMaxTriangles = uint64_t{1} << 31;  // of all instances

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
}

// Matrices that squash a mesh flat have no inverse; their instances are baked, so that nobody has to invert them. The
// volume that its columns span is compared with their lengths', so that a scene's scale does not matter; and a float
// must hold it.
bool isInvertible(const glm::dmat4& matrix) {
  const glm::dmat3 linear(matrix);
  const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  const double determinant = std::abs(glm::determinant(linear));
  return std::isfinite(lengths) && determinant > 1e-9 * lengths && determinant > 1e-30 && determinant < 1e30;
}

// EXT_mesh_gpu_instancing: a node's mesh, placed once an element of TRANSLATION, ROTATION and SCALE.
std::vector<PlacedNode> instancesOf(GltfDocument& document, const PlacedNode& placed) {
  const tinygltf::Node& node = document.model().nodes[placed.node];
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end()) return {placed};
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  std::optional<size_t> count;
  const auto find = [&](const char* name, int components) -> std::optional<AccessorView> {
    if (!attributes.Has(name)) return std::nullopt;
    AccessorView view(document, attributes.Get(name).GetNumberAsInt());
    if (view.componentCount() != components || (count && *count != view.count()))
      document.refuse(fmt::format("node {}: its instances' {} does not fit", placed.node, name), kRemedy);
    count = view.count();
    return view;
  };
  const auto translations = find("TRANSLATION", 3), rotations = find("ROTATION", 4), scales = find("SCALE", 3);
  if (!count) return {placed};
  document.spend(*count * sizeof(PlacedNode));
  std::vector<PlacedNode> instances(*count, placed);
  for (size_t i = 0; i < *count; ++i) {
    glm::dmat4 local(1.0);
    if (rotations) {
      const glm::dvec4 q(rotations->floats(i));
      local = glm::mat4_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    }
    for (int c = 0; c < 3 && scales; ++c) local[c] *= static_cast<double>(scales->floats(i)[c]);
    if (translations) local[3] = glm::dvec4(glm::dvec3(translations->floats(i)), 1.0);
    instances[i].worldFromNode = placed.worldFromNode * local;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        if (!std::isfinite(instances[i].worldFromNode[c][r]))
          document.refuse(fmt::format("node {}: its instance {} is placed at infinity", placed.node, i), kRemedy);
  }
  return instances;
}

// The nodes that show a mesh, each as often as it shows it.
std::vector<PlacedNode> placedMeshes(GltfDocument& document, const std::vector<PlacedNode>& nodes) {
  std::vector<PlacedNode> placed;
  for (const PlacedNode& node : nodes) {
    if (document.model().nodes[node.node].mesh < 0 || !node.visible) continue;
    const std::vector<PlacedNode> instances = instancesOf(document, node);
    placed.insert(placed.end(), instances.begin(), instances.end());
  }
  return placed;
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
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

// Turns the nodes' meshes into the scene's meshes and instances. A mesh that one node uses is baked; those
// that several use keep their matrices, but for nodes whose matrix has no inverse, which get a baked copy.
class GeometryLoader {
 public:
  // `all`: placeNodes' list, which must outlive the loader.
  GeometryLoader(GltfDocument& document, Scene& scene, std::vector<UvSource> uvSources,
                 const std::vector<PlacedNode>& all)
      : document_(document), scene_(scene), uvSources_(std::move(uvSources)), all_(all) {}

  void load(const std::vector<PlacedNode>& nodes) {
    countUses(nodes);
    const std::vector<tinygltf::Mesh>& meshes = document_.model().meshes;
    parts_.resize(meshes.size());
    for (size_t i = 0; i < meshes.size(); ++i)
      if (uses_[i].all > 0) loadParts(static_cast<int>(i));
    checkTriangles(nodes);
    chooseOrigin(nodes);
    for (const PlacedNode& placed : nodes) addInstances(placed);
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
      checkMeshNode(document_, placed.node);
      ++uses_[mesh].all;
      if (isInvertible(placed.worldFromNode)) ++uses_[mesh].invertible;
      instances += model.meshes[mesh].primitives.size();
    }
    if (instances > kMaxInstances)
      document_.refuse(fmt::format("has {} instances, more than {}", instances, kMaxInstances), "merge meshes");
  }

  void loadParts(int index) {
    const tinygltf::Mesh& source = document_.model().meshes[index];
    const std::string name = source.name.empty() ? fmt::format("mesh {}", index) : printable(source.name);
    for (size_t k = 0; k < source.primitives.size(); ++k) {
      const int material = source.primitives[k].material;
      const UvSource uvSource = material < 0 ? UvSource{} : uvSources_[material];
      const std::string where = fmt::format("mesh {}, primitive {}", index, k);
      std::optional<Mesh> mesh = loadPrimitive(document_, source.primitives[k], uvSource, where);
      if (!mesh || mesh->indices.empty()) continue;
      mesh->name = source.primitives.size() == 1 ? name : fmt::format("{} {}", name, k);
      mesh->material = material < 0 ? defaultMaterial() : material;
      if (scene_.materials[mesh->material].alphaMode == AlphaMode::Mask)
        mesh->material = withAlpha(mesh->material, vertexAlpha(document_, source.primitives[k], where));
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

  // A material whose alpha is multiplied by that of the vertices.
  int withAlpha(int material, float alpha) {
    if (alpha == 1.0f) return material;
    const auto known = faded_.find({material, alpha});
    if (known != faded_.end()) return known->second;
    Material faded = scene_.materials[material];
    faded.baseColor.w *= alpha;
    scene_.materials.push_back(std::move(faded));
    return faded_[{material, alpha}] = static_cast<int>(scene_.materials.size()) - 1;
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
      for (const Part& part : parts_[mesh]) triangles += scene_.meshes[part.mesh].indices.size() / 3;
    }
    if (triangles == 0) document_.refuse("has no triangles in its scene", "name a file with meshes of triangles");
    if (triangles > kMaxTriangles)
      document_.refuse(fmt::format("has {} triangles, more than 2^31", triangles), "split the scene");
  }

  // Floats far from zero are too coarse for shadows. A scene that lies four times its size or more from the file's
  // origin gets one of its own, a multiple of a power of two: where the file's coordinates are exact they stay so, and
  // no coordinate has lost more than three of its bits.
  void chooseOrigin(const std::vector<PlacedNode>& nodes) {
    glm::dvec3 lower(std::numeric_limits<double>::max()), upper(std::numeric_limits<double>::lowest());
    for (const PlacedNode& placed : nodes) {
      for (const Part& part : parts_[document_.model().nodes[placed.node].mesh]) {
        for (int corner = 0; corner < 8; ++corner) {
          const glm::dvec3 point(placed.worldFromNode * glm::dvec4(cornerOf(part, corner), 1.0));
          lower = glm::min(lower, point);
          upper = glm::max(upper, point);
        }
      }
    }
    const double size = glm::length(upper - lower);
    if (!(size > 0.0) || !std::isfinite(size)) return;
    const double step = std::exp2(std::ceil(std::log2(8.0 * size)));
    scene_.originW = glm::round(0.5 * (lower + upper) / step) * step;
    if (scene_.originW == glm::dvec3(0.0)) return;
    // Doubles have 29 bits more than floats.
    if (glm::length(scene_.originW) > 0x1p29 * size)
      document_.refuse(
          fmt::format("lies {:g} m from its origin, too far for its size of {:g} m", glm::length(scene_.originW), size),
          "move the scene to its origin");
    document_.notes.push_back(
        fmt::format("the scene lies {:g} m from its origin; Gnomon works relative to {:g},{:g},{:g}",
                    glm::length(0.5 * (lower + upper)), scene_.originW.x, scene_.originW.y, scene_.originW.z));
  }

  void addInstances(PlacedNode placed) {
    placed.worldFromNode[3] -= glm::dvec4(scene_.originW, 0.0);
    const tinygltf::Node& node = document_.model().nodes[placed.node];
    Uses& uses = uses_[node.mesh];
    ++uses.done;
    const bool shared = uses.all > 1 && isInvertible(placed.worldFromNode);
    // Nobody else needs the mesh as it is in the file.
    const bool inPlace = uses.all == 1 || (uses.invertible == 0 && uses.done == uses.all);
    std::string path = placed.parent < 0 ? "" : printable(pathOf(document_, all_, placed));
    if (path == node.name) path.clear();
    for (const Part& part : parts_[node.mesh]) {
      checkBounds(part, placed);
      Instance instance;
      instance.mesh = part.mesh;
      instance.name = node.name.empty() ? scene_.meshes[part.mesh].name : printable(node.name);
      instance.path = path;
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

  static glm::dvec3 cornerOf(const Part& part, int corner) {
    return {corner & 1 ? part.upper.x : part.lower.x, corner & 2 ? part.upper.y : part.lower.y,
            corner & 4 ? part.upper.z : part.lower.z};
  }

  // The corners of the mesh's own bounds, placed, enclose all of its vertices.
  void checkBounds(const Part& part, const PlacedNode& placed) const {
    for (int corner = 0; corner < 8; ++corner)
      checkNear(document_, glm::dvec3(placed.worldFromNode * glm::dvec4(cornerOf(part, corner), 1.0)), placed.node);
  }

  GltfDocument& document_;
  Scene& scene_;
  std::vector<UvSource> uvSources_;
  const std::vector<PlacedNode>& all_;
  std::vector<Uses> uses_;                // of each glTF mesh, by nodes of the scene
  std::vector<std::vector<Part>> parts_;  // of each glTF mesh
  std::map<std::pair<int, float>, int> faded_;
  int defaultMaterial_ = -1;
};

Scene sceneOf(GltfDocument& document) {
  Scene scene;
  scene.name = printable(std::filesystem::path(document.name()).stem().string());
  std::vector<UvSource> uvSources = loadMaterials(document, scene);
  const std::vector<PlacedNode> nodes = placeNodes(document);
  GeometryLoader(document, scene, std::move(uvSources), nodes).load(placedMeshes(document, nodes));
  loadLightsAndCameras(document, nodes, scene);
  scene.notes = document.notes;
  scene.harmlessNotes = document.harmlessNotes;
  return scene;
}

// tinygltf and the standard library throw what they like; a person gets one line about the file.
Scene loadBytes(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                const GltfOptions& options) {
  try {
    GltfDocument document(bytes, name, folder, options);
    return sceneOf(document);
  } catch (const UsageError&) {
    throw;
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

Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options) {
  const std::string bytes = readFile(path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return loadBytes(bytes, path.string(), folder, options);
}

Scene loadGltfFromMemory(const unsigned char* bytes, size_t size, const std::string& name) {
  return loadBytes({reinterpret_cast<const char*>(bytes), size}, name, {}, {});
}

}  // namespace gnomon
