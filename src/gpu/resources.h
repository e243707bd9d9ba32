#pragma once
// Buffers and images that own their memory. All images stay in VK_IMAGE_LAYOUT_GENERAL.

#include "gpu/device.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace gnomon::gpu {

enum class Memory {
  Device,    // fast for the GPU; filled and read through a staging copy
  Readback,  // host visible and cached: what the CPU reads
};

struct BufferDesc {
  const char* name = nullptr;  // mandatory
  VkDeviceSize size = 0;       // bytes; 0 is made 4, so that an empty array still binds
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // transfer source and destination are added
  Memory memory = Memory::Device;
  // Of a texel buffer, which shaders fetch texel by texel (usage VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT).
  VkFormat texels = VK_FORMAT_UNDEFINED;
};

class Buffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, const BufferDesc& desc);
  VkBuffer handle() const { return buffer_.get(); }
  VkBufferView view() const { return view_.get(); }  // of a texel buffer
  VkDeviceSize size() const { return size_; }
  // Mapped memory: always for Readback, and for Device where the device's memory is host visible and cached
  // (lavapipe, integrated GPUs); else nullptr.
  std::byte* mapped() const { return mapped_; }

 private:
  OwnedChild<VkBuffer, vkDestroyBuffer> buffer_;
  OwnedChild<VkDeviceMemory, vkFreeMemory> memory_;
  OwnedChild<VkBufferView, vkDestroyBufferView> view_;
  VkDeviceSize size_ = 0;
  std::byte* mapped_ = nullptr;
};

struct ImageDesc {
  const char* name = nullptr;  // mandatory; a literal, since the image keeps the pointer
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t width = 1, height = 1;  // texels
  uint32_t layerCount = 1;         // the view is 2D_ARRAY when `array`, else 2D
  bool array = false;
  bool cube = false;            // of an array of 6: the view is CUBE
  VkImageUsageFlags usage = 0;  // transfer source and destination are added
};

class Image {
 public:
  Image() = default;
  // Brings the image to GENERAL before it returns.
  Image(const Device& device, const ImageDesc& desc);
  // One component of all layers of another image, which must stay: shaders that sample it find it in x, and a download
  // gives nothing else. `format`: of the component.
  Image(const Device& device, const char* name, const Image& of, VkFormat format, int component);
  VkImage handle() const { return component_ ? component_->of : image_.get(); }
  VkImageView view() const { return view_.get(); }                                  // all layers
  VkImageView layerView(uint32_t layer) const { return layerViews_[layer].get(); }  // one layer, 2D
  const ImageDesc& desc() const { return desc_; }
  VkImageAspectFlags aspect() const;

  struct Component {
    VkImage of = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;  // of the other image
    int index = 0;
  };
  const std::optional<Component>& component() const { return component_; }

 private:
  std::optional<Component> component_;
  OwnedChild<VkImage, vkDestroyImage> image_;
  OwnedChild<VkDeviceMemory, vkFreeMemory> memory_;
  OwnedChild<VkImageView, vkDestroyImageView> view_;
  std::vector<OwnedChild<VkImageView, vkDestroyImageView>> layerViews_;
  ImageDesc desc_;
};

// Copies bytes in and waits.
void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> bytes);

// Copies the first bytes out and waits.
void download(const Device& device, const Buffer& buffer, std::span<std::byte> bytes);

// All layers, tightly packed, layer after layer, rows from the top. Depth images give their 32-bit floats.
std::vector<std::byte> download(const Device& device, const Image& image);

template <typename T>
Buffer createBufferWith(const Device& device, const char* name, const std::vector<T>& values,
                        VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
  Buffer buffer(device, {.name = name, .size = values.size() * sizeof(T), .usage = usage});
  if (!values.empty()) upload(device, buffer, std::as_bytes(std::span(values)));
  return buffer;
}

// A texel buffer, one texel of the format a value.
template <typename T>
Buffer createTexelsWith(const Device& device, const char* name, VkFormat format, const std::vector<T>& values) {
  Buffer buffer(device, {.name = name,
                         .size = std::max<size_t>(values.size(), 1) * sizeof(T),
                         .usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                         .texels = format});
  if (!values.empty()) upload(device, buffer, std::as_bytes(std::span(values)));
  return buffer;
}

// `count` values, or all.
template <typename T>
std::vector<T> downloadAs(const Device& device, const Buffer& buffer, std::optional<size_t> count = {}) {
  std::vector<T> values(count.value_or(buffer.size() / sizeof(T)));
  download(device, buffer, std::as_writable_bytes(std::span(values)));
  return values;
}
template <typename T>
std::vector<T> downloadAs(const Device& device, const Image& image) {
  const std::vector<std::byte> bytes = download(device, image);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace gnomon::gpu
