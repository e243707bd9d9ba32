#include "gltf_text.h"

#include "scene/gltf.h"

namespace gnomon {

using nlohmann::json;

GltfText::GltfText() {
  document["asset"]["version"] = "2.0";
  document["scene"] = 0;
  document["scenes"] = json::array({{{"nodes", json::array()}}});
  for (const char* name : {"nodes", "meshes", "accessors", "bufferViews"}) document[name] = json::array();
}

int GltfText::addAccessor(const void* bytes, size_t size, size_t count, int componentType, const char* type,
                          bool normalized) {
  buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
  document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", size}});
  buffer_.append(static_cast<const char*>(bytes), size);
  document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                   {"componentType", componentType},
                                   {"count", count},
                                   {"type", type},
                                   {"normalized", normalized}});
  return static_cast<int>(document["accessors"].size()) - 1;
}

int GltfText::addVec3(const std::vector<glm::vec3>& values) {
  return addAccessor(values.data(), values.size() * sizeof(glm::vec3), values.size(), 5126, "VEC3", false);
}

int GltfText::addVec2(const std::vector<glm::vec2>& values) {
  return addAccessor(values.data(), values.size() * sizeof(glm::vec2), values.size(), 5126, "VEC2", false);
}

int GltfText::addIndices(const std::vector<uint32_t>& values) {
  return addAccessor(values.data(), values.size() * sizeof(uint32_t), values.size(), 5125, "SCALAR", false);
}

int GltfText::addMesh(const json& attributes, int indices, int mode, int material) {
  json primitive = {{"attributes", attributes}, {"mode", mode}};
  if (indices >= 0) primitive["indices"] = indices;
  if (material >= 0) primitive["material"] = material;
  document["meshes"].push_back({{"primitives", json::array({primitive})}});
  return static_cast<int>(document["meshes"].size()) - 1;
}

int GltfText::addNode(const json& node) {
  document["nodes"].push_back(node);
  const int index = static_cast<int>(document["nodes"].size()) - 1;
  document["scenes"][0]["nodes"].push_back(index);
  return index;
}

json GltfText::finished() const {
  json whole = document;
  whole["buffers"] = json::array(
      {{{"byteLength", buffer_.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}});
  return whole;
}

Scene GltfText::load() const {
  const std::string text = finished().dump();
  return loadGltfFromMemory(reinterpret_cast<const unsigned char*>(text.data()), text.size(), "made.gltf");
}

std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace gnomon
