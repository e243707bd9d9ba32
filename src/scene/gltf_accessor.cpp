#include "scene/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

static_assert(std::endian::native == std::endian::little);  // sparse indices are copied as they lie

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

AccessorView::AccessorView(GltfDocument& document, int accessor) : accessor_(accessor) {
  const tinygltf::Accessor& source = document.model().accessors[accessor];
  const auto refuse = [&](const std::string& what) {
    document.refuse(fmt::format("accessor {}: {}", accessor, what), kRemedy);
  };
  componentCount_ = componentsOf(source.type);
  if (componentCount_ == 0) refuse("is a matrix, which no vertex attribute of a shape is");
  componentType_ = source.componentType;
  if (componentType_ == TINYGLTF_COMPONENT_TYPE_INT || componentType_ == TINYGLTF_COMPONENT_TYPE_DOUBLE)
    refuse(fmt::format("has the component type {}, which glTF does not allow", componentType_));
  normalized_ = source.normalized;
  count_ = source.count;
  const size_t elementSize = static_cast<size_t>(componentCount_) * tinygltf::GetComponentSizeInBytes(componentType_);
  stride_ = elementSize;
  if (source.bufferView >= 0) {
    const size_t byteStride = document.model().bufferViews[source.bufferView].byteStride;
    if (byteStride != 0) stride_ = byteStride;
    if (stride_ < elementSize)
      refuse(fmt::format("its stride of {} bytes is smaller than its elements of {}", stride_, elementSize));
    const std::span<const unsigned char> bytes = document.viewBytes(source.bufferView);
    // All of these are at most 2^53 and the stride at most 256, so nothing here overflows 64 bits.
    const size_t end = count_ == 0 ? 0 : source.byteOffset + stride_ * (count_ - 1) + elementSize;
    if (end > bytes.size())
      refuse(fmt::format("{} elements end at byte {} of bufferView {}, which has {}", count_, end, source.bufferView,
                         bytes.size()));
    data_ = bytes.data() + source.byteOffset;
  }
  if (source.bufferView < 0 || source.sparse.isSparse) writeOut(document, elementSize);
}

AccessorView::AccessorView(int accessor, int componentCount, std::vector<float> values)
    : accessor_(accessor),
      count_(values.size() / static_cast<size_t>(componentCount)),
      stride_(sizeof(float) * static_cast<size_t>(componentCount)),
      componentCount_(componentCount),
      componentType_(TINYGLTF_COMPONENT_TYPE_FLOAT) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  owned_ = std::make_shared<const std::vector<unsigned char>>(bytes, bytes + sizeof(float) * values.size());
  data_ = owned_->data();
}

// glTF 2.0, section 3.6.2.3: zeros, or the bufferView's elements, and over them the sparse ones.
void AccessorView::writeOut(GltfDocument& document, size_t elementSize) {
  const tinygltf::Accessor& source = document.model().accessors[accessor_];
  const auto refuse = [&](const std::string& what) {
    document.refuse(fmt::format("accessor {}: {}", accessor_, what), kRemedy);
  };
  // An honest file has as many bytes of something else; zeros alone could ask for any amount.
  if (count_ > (uint64_t{1} << 40)) refuse(fmt::format("has {} elements", count_));
  document.spend(count_ * elementSize);
  std::vector<unsigned char> bytes(count_ * elementSize, 0);
  if (source.bufferView >= 0)
    for (size_t i = 0; i < count_; ++i) std::memcpy(&bytes[i * elementSize], data_ + i * stride_, elementSize);
  stride_ = elementSize;
  if (source.sparse.isSparse) {
    const size_t changed = static_cast<size_t>(std::max(source.sparse.count, 0));
    const int type = source.sparse.indices.componentType;
    const auto partOf = [&](int bufferView, size_t offset, size_t size, const char* what) {
      const std::span<const unsigned char> view = document.viewBytes(bufferView);
      if (offset > view.size() || changed > (view.size() - offset) / size)
        refuse(fmt::format("its {} sparse {} end beyond bufferView {}", changed, what, bufferView));
      return view.subspan(offset, changed * size);
    };
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
      refuse("its sparse indices are not unsigned");
    const size_t indexSize = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(type));
    const auto indices = partOf(source.sparse.indices.bufferView, static_cast<size_t>(source.sparse.indices.byteOffset),
                                indexSize, "indices");
    const auto values = partOf(source.sparse.values.bufferView, static_cast<size_t>(source.sparse.values.byteOffset),
                               elementSize, "values");
    for (size_t k = 0; k < changed; ++k) {
      uint32_t at = 0;
      std::memcpy(&at, &indices[k * indexSize], indexSize);
      if (at >= count_) refuse(fmt::format("its sparse index {} is beyond its {} elements", at, count_));
      std::memcpy(&bytes[at * elementSize], &values[k * elementSize], elementSize);
    }
  }
  owned_ = std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
  data_ = owned_->data();
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
