#pragma once
// RAII handles for Vulkan objects, and a check that throws with the call and the name of its result.

#include <vulkan/vulkan.h>

#include <shared_mutex>
#include <utility>

namespace gnomon::gpu {

// Throws WorldError "vkCreateBuffer failed: VK_ERROR_OUT_OF_DEVICE_MEMORY; ...".
void throwVulkanError(VkResult result, const char* call);

#define GNOMON_VK_CHECK(call)                                                             \
  do {                                                                                    \
    const VkResult gnomonResult = (call);                                                 \
    if (gnomonResult != VK_SUCCESS) ::gnomon::gpu::throwVulkanError(gnomonResult, #call); \
  } while (false)

// The loader looks a device up for some calls (vkSetDebugUtilsObjectNameEXT, vkCreateSwapchainKHR,
// vkGetDeviceProcAddr) in lists of all instances and devices of the process, and takes no lock for it; on another
// thread vkDestroyDevice may free what it is looking at (Vulkan-Loader 1.3.239, loader_get_icd_and_device). So those
// calls are made with this held shared, and what makes or destroys an instance or a device holds it alone.
std::shared_mutex& loaderLists();

void destroyInstance(VkInstance instance, const VkAllocationCallbacks* allocator);
void destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator);

// An instance or a device: destroyed by itself.
template <typename Handle, auto Destroy>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Handle handle) : handle_(handle) {}
  Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, Handle{})) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_) Destroy(handle_, nullptr);
  }
  Handle get() const { return handle_; }
  explicit operator bool() const { return handle_ != Handle{}; }

 private:
  Handle handle_{};
};

// What a device made: destroyed through it.
template <typename Handle, auto Destroy>
class OwnedChild {
 public:
  OwnedChild() = default;
  OwnedChild(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
  OwnedChild(OwnedChild&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
  OwnedChild& operator=(OwnedChild&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~OwnedChild() {
    if (handle_) Destroy(device_, handle_, nullptr);
  }
  Handle get() const { return handle_; }
  explicit operator bool() const { return handle_ != Handle{}; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_{};
};

}  // namespace gnomon::gpu
