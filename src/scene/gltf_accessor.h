#pragma once
// Typed views of glTF accessors, checked against the bytes that back them. Internal to the loader.

#include "scene/gltf_document.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

class AccessorView {
 public:
  // Refuses unknown types, strides that overlap and ranges beyond the buffer. What has no bufferView is zero; what is
  // sparse is written out.
  AccessorView(GltfDocument& document, int accessor);

  // `count` elements of floats that lie elsewhere: those of a compressed mesh. `accessor` names them in messages.
  AccessorView(int accessor, int componentCount, std::vector<float> values);

  size_t count() const { return count_; }
  int accessor() const { return accessor_; }
  int componentCount() const { return componentCount_; }
  int componentType() const { return componentType_; }  // TINYGLTF_COMPONENT_TYPE_*

  // Components 0..componentCount-1 of element i as floats; integers are scaled where the accessor is normalized.
  glm::vec4 floats(size_t i) const;

  // Element i of an index accessor (unsigned scalars).
  uint32_t index(size_t i) const;

 private:
  void writeOut(GltfDocument& document, size_t elementSize);

  int accessor_ = 0;
  std::shared_ptr<const std::vector<unsigned char>> owned_;  // where the bytes are no buffer's
  const unsigned char* data_ = nullptr;
  size_t count_ = 0;
  size_t stride_ = 0;  // bytes
  int componentCount_ = 0;
  int componentType_ = 0;
  bool normalized_ = false;
};

}  // namespace gnomon
