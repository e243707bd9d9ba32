#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

template <typename T>
T readAs(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

// glTF 2.0, section 3.11: f = c / 255 and f = max(c / 127, -1), and so on.
template <typename T>
float component(const unsigned char* bytes, bool normalized) {
  const T value = readAs<T>(bytes);
  if (!normalized) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

int componentsOf(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

AccessorView::AccessorView(const GltfDocument& document, int accessor) : accessor_(accessor) {
  const tinygltf::Model& model = document.model();
  const tinygltf::Accessor& source = model.accessors[accessor];
  const auto refuse = [&](const std::string& what, const char* remedy = kRemedy) {
    document.refuse(fmt::format("accessor {}: {}", accessor, what), remedy);
  };
  if (source.sparse.isSparse) refuse("is sparse, which Gnomon does not read", "export it with plain accessors");
  if (source.bufferView < 0) refuse("has no bufferView");
  componentCount_ = componentsOf(source.type);
  if (componentCount_ == 0) refuse("is a matrix, which no vertex attribute of a shape is");
  componentType_ = source.componentType;
  if (componentType_ == TINYGLTF_COMPONENT_TYPE_INT || componentType_ == TINYGLTF_COMPONENT_TYPE_DOUBLE)
    refuse(fmt::format("has the component type {}, which glTF does not allow", componentType_));
  normalized_ = source.normalized;
  count_ = source.count;

  const tinygltf::BufferView& view = model.bufferViews[source.bufferView];
  const size_t elementSize = static_cast<size_t>(componentCount_) * tinygltf::GetComponentSizeInBytes(componentType_);
  stride_ = view.byteStride == 0 ? elementSize : view.byteStride;
  if (stride_ < elementSize)
    refuse(fmt::format("its stride of {} bytes is smaller than its elements of {}", stride_, elementSize));
  // All of these are at most 2^53 and the stride at most 252, so nothing here overflows 64 bits.
  const size_t end = count_ == 0 ? 0 : source.byteOffset + stride_ * (count_ - 1) + elementSize;
  if (end > view.byteLength)
    refuse(fmt::format("{} elements end at byte {} of bufferView {}, which has {}", count_, end, source.bufferView,
                       view.byteLength));
  const std::vector<unsigned char>& data = model.buffers[view.buffer].data;
  if (view.byteOffset + view.byteLength > data.size()) refuse("its bufferView ends beyond its buffer");
  data_ = data.data() + view.byteOffset + source.byteOffset;
}

glm::vec4 AccessorView::floats(size_t i) const {
  const unsigned char* element = data_ + i * stride_;
  const size_t size = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(componentType_));
  glm::vec4 out(0.0f);
  for (int c = 0; c < componentCount_; ++c) {
    const unsigned char* bytes = element + size * c;
    switch (componentType_) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        out[c] = readAs<float>(bytes);
        break;
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        out[c] = component<int8_t>(bytes, normalized_);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        out[c] = component<uint8_t>(bytes, normalized_);
        break;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        out[c] = component<int16_t>(bytes, normalized_);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        out[c] = component<uint16_t>(bytes, normalized_);
        break;
      default:
        out[c] = component<uint32_t>(bytes, normalized_);
        break;
    }
  }
  return out;
}

uint32_t AccessorView::index(size_t i) const {
  const unsigned char* element = data_ + i * stride_;
  switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return readAs<uint8_t>(element);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return readAs<uint16_t>(element);
    default:
      return readAs<uint32_t>(element);
  }
}

}  // namespace gnomon
