#pragma once
// The node hierarchy of a glTF file, flattened in double. Internal to the loader.

#include "scene/gltf_document.h"

#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

struct PlacedNode {
  int node = 0;
  glm::dmat4 worldFromNode{1.0};
};

// All nodes of the scene that the file shows, parents before children, in the file's order. Refuses nodes
// with two parents, circles, matrices that are not affine, and places at infinity.
std::vector<PlacedNode> placeNodes(const GltfDocument& document);

// Refuses points so far away that floats cannot tell metres apart.
void checkNear(const GltfDocument& document, const glm::dvec3& point, int node);

}  // namespace gnomon
