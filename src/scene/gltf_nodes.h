#pragma once
// The node hierarchy of a glTF file, flattened in double. Internal to the loader.

#include "scene/gltf_document.h"

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

struct PlacedNode {
  int node = 0;
  glm::dmat4 worldFromNode{1.0};
  bool visible = true;  // KHR_node_visibility, its ancestors' too
  int parent = -1;      // its place in placeNodes' list
};

// The names of a node's nearest ancestors and its own, "rig/lamp"; those without a name are left out.
std::string pathOf(const GltfDocument& document, const std::vector<PlacedNode>& nodes, const PlacedNode& placed);

// All nodes of the scene that the file shows, or of the one asked for (GltfOptions::scene), parents before children, in
// the file's order. Refuses nodes with two parents, circles, matrices that are not affine, and places at infinity.
std::vector<PlacedNode> placeNodes(const GltfDocument& document);

// Refuses points, relative to the scene's origin, so far away that products of coordinates leave a float's range.
void checkNear(const GltfDocument& document, const glm::dvec3& point, int node);

}  // namespace gnomon
