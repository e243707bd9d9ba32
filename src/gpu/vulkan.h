#pragma once
// RAII handles for Vulkan objects, and a check that throws with the call and the name of its result.

#include <vulkan/vulkan.h>

#include <utility>

namespace gnomon::gpu {

// Throws WorldError "vkCreateBuffer failed: VK_ERROR_OUT_OF_DEVICE_MEMORY; ...".
void throwVulkanError(VkResult result, const char* call);

#define GNOMON_VK_CHECK(call)                                                             \
  do {                                                                                    \
    const VkResult gnomonResult = (call);                                                 \
    if (gnomonResult != VK_SUCCESS) ::gnomon::gpu::throwVulkanError(gnomonResult, #call); \
  } while (false)

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
