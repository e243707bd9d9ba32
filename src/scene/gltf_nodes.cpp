#include "scene/gltf_nodes.h"

#include "base/error.h"
#include "base/message.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/quaternion.hpp>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

// Metres. The largest products of coordinates are the squares of a triangle's normal, of the fourth power of a length:
// (2 * 1e9)^4 = 1.6e37, within a float's 3.4e38.
constexpr double kFarthest = 1e9;

// What exporters' rounding leaves of an affine matrix's last row.
constexpr double kAffineRounding = 1e-6;

glm::dmat4 localMatrix(const GltfDocument& document, int index) {
  const tinygltf::Node& node = document.model().nodes[index];
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) matrix[c][r] = node.matrix[4 * c + r];
    for (int c = 0; c < 4; ++c) {
      if (!(std::abs(matrix[c][3] - (c == 3 ? 1.0 : 0.0)) <= kAffineRounding))
        document.refuse(fmt::format("node {} has a matrix that is not affine", index), kRemedy);
      matrix[c][3] = c == 3 ? 1.0 : 0.0;
    }
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

bool isShown(const tinygltf::Node& node) {
  const auto it = node.extensions.find("KHR_node_visibility");
  return it == node.extensions.end() || !it->second.Has("visible") || it->second.Get("visible").Get<bool>();
}

bool isFinite(const glm::dmat4& matrix) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(matrix[c][r])) return false;
  return true;
}

// Which of its scenes is read. Throws UsageError where one is asked for that is not there.
int sceneIndex(const GltfDocument& document) {
  const tinygltf::Model& model = document.model();
  const std::optional<int> asked = document.options().scene;
  if (!asked) return std::max(model.defaultScene, 0);
  if (*asked >= 0 && *asked < static_cast<int>(model.scenes.size())) return *asked;
  std::string scenes;
  for (size_t i = 0; i < model.scenes.size(); ++i)
    scenes += fmt::format("{}{}{}", i == 0 ? "" : ", ", i,
                          model.scenes[i].name.empty() ? "" : " (" + printable(model.scenes[i].name) + ")");
  throw UsageError(fmt::format("--scene-index {}: {} has {}", *asked, document.name(),
                               model.scenes.empty() ? "no list of scenes; leave the flag out" : "scenes " + scenes));
}

// The roots of the scene that is read. Every node has one parent at most, and none is its own ancestor.
std::vector<int> sceneRoots(const GltfDocument& document) {
  const tinygltf::Model& model = document.model();
  std::vector<int> parent(model.nodes.size(), -1);
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    for (int child : model.nodes[i].children) {
      if (parent[child] >= 0)
        document.refuse(fmt::format("node {} is a child of both node {} and node {}", child, parent[child], i),
                        kRemedy);
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
  if (model.scenes.empty() && !document.options().scene) return roots;
  roots = model.scenes[sceneIndex(document)].nodes;
  std::vector<bool> listed(model.nodes.size(), false);
  for (int root : roots) {
    if (parent[root] >= 0)
      document.refuse(fmt::format("node {} is a root of the scene and a child of node {}", root, parent[root]),
                      kRemedy);
    if (listed[root]) document.refuse(fmt::format("node {} is listed twice in the scene", root), kRemedy);
    listed[root] = true;
  }
  return roots;
}

}  // namespace

std::vector<PlacedNode> placeNodes(const GltfDocument& document) {
  std::vector<PlacedNode> placed, open;
  const std::vector<int> roots = sceneRoots(document);
  const auto openChildren = [&](const PlacedNode& parent, int parentPlace, const std::vector<int>& children) {
    for (auto it = children.rbegin(); it != children.rend(); ++it)
      open.push_back({.node = *it,
                      .worldFromNode = parentPlace < 0
                                           ? localMatrix(document, *it)  // as it is: 0 * -1 + 0 has lost its sign
                                           : parent.worldFromNode * localMatrix(document, *it),
                      .visible = parent.visible && isShown(document.model().nodes[*it]),
                      .parent = parentPlace});
  };
  openChildren(PlacedNode{}, -1, roots);
  while (!open.empty()) {
    const PlacedNode current = open.back();
    open.pop_back();
    if (!isFinite(current.worldFromNode))
      document.refuse(fmt::format("node {} is placed at infinity", current.node), kRemedy);
    placed.push_back(current);
    openChildren(current, static_cast<int>(placed.size()) - 1, document.model().nodes[current.node].children);
  }
  return placed;
}

std::string pathOf(const GltfDocument& document, const std::vector<PlacedNode>& nodes, const PlacedNode& placed) {
  constexpr int kMostNames = 8;
  std::string path = document.model().nodes[placed.node].name;
  int names = 1;
  for (int at = placed.parent; at >= 0 && names < kMostNames; at = nodes[at].parent) {
    const std::string& name = document.model().nodes[nodes[at].node].name;
    if (name.empty()) continue;
    path = path.empty() ? name : name + "/" + path;
    ++names;
  }
  return path;
}

void checkNear(const GltfDocument& document, const glm::dvec3& point, int node) {
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(point[c]) <= kFarthest))
      document.refuse(fmt::format("node {} reaches beyond {} m from the scene's centre", node, kFarthest),
                      "scale the scene: glTF's unit is the metre");
}

}  // namespace gnomon
