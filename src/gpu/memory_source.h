#pragma once
// Where the memory of buffers and images comes from, if not from vkAllocateMemory: an allocator that a renderer has
// already.

#include <vulkan/vulkan.h>

namespace gnomon::gpu {

struct MemoryRequest {
  const char* name = nullptr;
  VkMemoryRequirements needs{};
  VkMemoryPropertyFlags required = 0;
  VkMemoryPropertyFlags preferred = 0;
  // What it is for, one of the two: for dedicated allocations.
  VkBuffer buffer = VK_NULL_HANDLE;
  VkImage image = VK_NULL_HANDLE;
};

struct MemoryBlock {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;  // bytes
  // Where the CPU finds it, if it is host visible and coherent; must be there where `required` says host visible.
  void* mapped = nullptr;
  void* user = nullptr;  // the source's own
};

class MemorySource {
 public:
  // Throws where there is none left; what it throws passes through.
  virtual MemoryBlock allocate(const MemoryRequest& request) = 0;
  virtual void release(const MemoryBlock& block) noexcept = 0;

 protected:
  ~MemorySource() = default;
};

}  // namespace gnomon::gpu
