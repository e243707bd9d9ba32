#pragma once
// What resources of a borrowed device need done on a queue before they are used: images go to GENERAL, buffers get
// their first contents. The next command buffer that is recorded (Commands) does it, in the order in which it was asked
// for.

#include "gpu/resources.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gnomon::gpu {

class PendingWork {
 public:
  explicit PendingWork(const Device& device) : device_(device) {}

  void bringToGeneral(VkImage image, VkImageAspectFlags aspect, uint32_t layerCount);
  // The bytes are copied. A large upload takes a staging buffer, which stays until releaseStaging().
  void upload(VkBuffer buffer, std::span<const std::byte> bytes);
  // What it was asked to do with this one, which goes.
  void forget(uint64_t handle);

  void record(VkCommandBuffer commands);
  // Once the device is done with what was recorded so far.
  void releaseStaging() { staging_.clear(); }

 private:
  struct Item {
    uint64_t handle = 0;
    VkImage image = VK_NULL_HANDLE;  // or a buffer
    VkImageAspectFlags aspect = 0;
    uint32_t layerCount = 0;
    VkBuffer buffer = VK_NULL_HANDLE;
    std::vector<std::byte> bytes;  // of a small upload
    const Buffer* staging = nullptr;
    VkDeviceSize size = 0;
  };

  const Device& device_;
  std::vector<Item> items_;
  std::vector<std::unique_ptr<Buffer>> staging_;
};

}  // namespace gnomon::gpu
