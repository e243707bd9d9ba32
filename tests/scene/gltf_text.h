#pragma once
// Small glTF files made in a test: a document to fill in, and its buffer.

#include "scene/scene.h"

#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace gnomon {

// Collects accessors and writes them out as one data: URI.
class GltfText {
 public:
  // Valid but empty: asset, one scene without nodes.
  GltfText();

  // Each returns the accessor's index.
  int addVec3(const std::vector<glm::vec3>& values);
  int addVec2(const std::vector<glm::vec2>& values);
  int addIndices(const std::vector<uint32_t>& values);
  // Raw bytes as `count` elements, for other component types.
  int addAccessor(const void* bytes, size_t size, size_t count, int componentType, const char* type, bool normalized);

  // A mesh of one primitive; `indices` -1: none. Returns the mesh's index.
  int addMesh(const nlohmann::json& attributes, int indices, int mode = 4, int material = -1);

  // A root node of the scene. Returns its index.
  int addNode(const nlohmann::json& node);

  // The document with its buffer.
  nlohmann::json finished() const;

  // Loads what has been put together. Throws WorldError.
  Scene load() const;

  nlohmann::json document;

 private:
  std::string buffer_;
};

std::string base64(const std::string& bytes);

}  // namespace gnomon
