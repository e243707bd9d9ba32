#pragma once
// Typed views of glTF accessors, checked against the bytes that back them. Internal to the loader.

#include "scene/gltf_document.h"

#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

namespace gnomon {

class AccessorView {
 public:
  // Refuses sparse accessors, unknown types, strides that overlap and ranges beyond the buffer.
  AccessorView(const GltfDocument& document, int accessor);

  size_t count() const { return count_; }
  int accessor() const { return accessor_; }
  int componentCount() const { return componentCount_; }
  int componentType() const { return componentType_; }  // TINYGLTF_COMPONENT_TYPE_*

  // Components 0..componentCount-1 of element i as floats; integers are scaled where the accessor is normalized.
  glm::vec4 floats(size_t i) const;

  // Element i of an index accessor (unsigned scalars).
  uint32_t index(size_t i) const;

 private:
  int accessor_ = 0;
  const unsigned char* data_ = nullptr;
  size_t count_ = 0;
  size_t stride_ = 0;  // bytes
  int componentCount_ = 0;
  int componentType_ = 0;
  bool normalized_ = false;
};

}  // namespace gnomon
