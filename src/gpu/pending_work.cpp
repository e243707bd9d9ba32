#include "gpu/pending_work.h"

#include "base/check.h"

#include <algorithm>
#include <cstring>

namespace gnomon::gpu {

namespace {

constexpr size_t kInlineBytes = 65536;  // vkCmdUpdateBuffer's most

}  // namespace

void PendingWork::bringToGeneral(VkImage image, VkImageAspectFlags aspect, uint32_t layerCount) {
  items_.push_back(
      {.handle = reinterpret_cast<uint64_t>(image), .image = image, .aspect = aspect, .layerCount = layerCount});
}

void PendingWork::upload(VkBuffer buffer, std::span<const std::byte> bytes) {
  Item item{.handle = reinterpret_cast<uint64_t>(buffer), .buffer = buffer, .size = bytes.size()};
  if (bytes.size() <= kInlineBytes && bytes.size() % 4 == 0) {
    item.bytes.assign(bytes.begin(), bytes.end());
  } else {
    staging_.push_back(std::make_unique<Buffer>(
        device_,
        BufferDesc{.name = "staging for upload", .size = bytes.size(), .usage = 0, .memory = Memory::Readback}));
    std::memcpy(staging_.back()->mapped(), bytes.data(), bytes.size());
    item.staging = staging_.back().get();
  }
  items_.push_back(std::move(item));
}

void PendingWork::forget(uint64_t handle) {
  std::erase_if(items_, [handle](const Item& item) { return item.handle == handle; });
}

void PendingWork::record(VkCommandBuffer commands) {
  for (const Item& item : items_) {
    if (item.image != VK_NULL_HANDLE) {
      recordToGeneral(commands, item.image, item.aspect, item.layerCount);
    } else if (item.staging != nullptr) {
      const VkBufferCopy region{0, 0, item.size};
      vkCmdCopyBuffer(commands, item.staging->handle(), item.buffer, 1, &region);
    } else {
      vkCmdUpdateBuffer(commands, item.buffer, 0, item.size, item.bytes.data());
    }
  }
  items_.clear();
}

}  // namespace gnomon::gpu
