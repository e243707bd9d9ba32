#pragma once
// Buffers and images that own their memory. All images stay in VK_IMAGE_LAYOUT_GENERAL.

#include "gpu/device.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
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

// Memory of one resource, given back where it came from.
class OwnedMemory {
 public:
  OwnedMemory() = default;
  OwnedMemory(VkDevice device, MemorySource* source, const MemoryBlock& block)
      : device_(device), source_(source), block_(block) {}
  OwnedMemory(OwnedMemory&& other) noexcept { swap(other); }
  OwnedMemory& operator=(OwnedMemory&& other) noexcept {
    swap(other);
    return *this;
  }
  ~OwnedMemory();
  const MemoryBlock& block() const { return block_; }

 private:
  void swap(OwnedMemory& other) {
    std::swap(device_, other.device_);
    std::swap(source_, other.source_);
    std::swap(block_, other.block_);
  }
  VkDevice device_ = VK_NULL_HANDLE;
  MemorySource* source_ = nullptr;
  MemoryBlock block_;
};

// A resource of a borrowed device that something may wait to be done with (pending_work.h): when it goes, that does.
class PendingTicket {
 public:
  PendingTicket() = default;
  PendingTicket(PendingWork* work, uint64_t handle) : work_(work), handle_(handle) {}
  PendingTicket(PendingTicket&& other) noexcept { swap(other); }
  PendingTicket& operator=(PendingTicket&& other) noexcept {
    swap(other);
    return *this;
  }
  ~PendingTicket();

 private:
  void swap(PendingTicket& other) {
    std::swap(work_, other.work_);
    std::swap(handle_, other.handle_);
  }
  PendingWork* work_ = nullptr;
  uint64_t handle_ = 0;
};

class Buffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, const BufferDesc& desc);
  // Somebody else's, which must stay.
  Buffer(VkBuffer lent, VkDeviceSize size) : lent_(lent), size_(size) {}
  VkBuffer handle() const { return lent_ ? lent_ : buffer_.get(); }
  VkBufferView view() const { return view_.get(); }  // of a texel buffer
  VkDeviceSize size() const { return size_; }
  // Mapped memory: always for Readback, and for Device where the device's memory is host visible and cached
  // (lavapipe, integrated GPUs); else nullptr.
  std::byte* mapped() const { return mapped_; }

 private:
  VkBuffer lent_ = VK_NULL_HANDLE;
  OwnedMemory memory_;
  OwnedChild<VkBuffer, vkDestroyBuffer> buffer_;
  OwnedChild<VkBufferView, vkDestroyBufferView> view_;
  PendingTicket ticket_;
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
  // Somebody else's view, which must stay, of an image that is in this layout where it is bound.
  Image(VkImageView lent, VkImageLayout layout, const ImageDesc& desc) : lent_(lent), layout_(layout), desc_(desc) {}
  VkImage handle() const { return component_ ? component_->of : image_.get(); }
  VkImageView view() const { return lent_ ? lent_ : view_.get(); }  // all layers
  VkImageLayout layout() const { return layout_; }
  bool isLent() const { return lent_ != VK_NULL_HANDLE; }
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
  VkImageView lent_ = VK_NULL_HANDLE;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_GENERAL;
  OwnedMemory memory_;
  OwnedChild<VkImage, vkDestroyImage> image_;
  PendingTicket ticket_;
  OwnedChild<VkImageView, vkDestroyImageView> view_;
  std::vector<OwnedChild<VkImageView, vkDestroyImageView>> layerViews_;
  ImageDesc desc_;
};

// From whatever an image held to GENERAL.
void recordToGeneral(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, uint32_t layerCount);

// Copies bytes in and waits. On a borrowed device that is only done with what was just made, and by the next command
// buffer.
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
