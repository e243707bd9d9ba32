#include "gpu/vulkan.h"

#include "base/error.h"

#include <mutex>
#include <string>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

std::string resultName(VkResult result) {
#define GNOMON_RESULT(name) \
  case name:                \
    return #name
  switch (result) {
    GNOMON_RESULT(VK_SUCCESS);
    GNOMON_RESULT(VK_NOT_READY);
    GNOMON_RESULT(VK_TIMEOUT);
    GNOMON_RESULT(VK_INCOMPLETE);
    GNOMON_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY);
    GNOMON_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY);
    GNOMON_RESULT(VK_ERROR_INITIALIZATION_FAILED);
    GNOMON_RESULT(VK_ERROR_DEVICE_LOST);
    GNOMON_RESULT(VK_ERROR_MEMORY_MAP_FAILED);
    GNOMON_RESULT(VK_ERROR_LAYER_NOT_PRESENT);
    GNOMON_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT);
    GNOMON_RESULT(VK_ERROR_FEATURE_NOT_PRESENT);
    GNOMON_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER);
    GNOMON_RESULT(VK_ERROR_TOO_MANY_OBJECTS);
    GNOMON_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED);
    GNOMON_RESULT(VK_ERROR_FRAGMENTED_POOL);
    GNOMON_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY);
    GNOMON_RESULT(VK_ERROR_INVALID_EXTERNAL_HANDLE);
    GNOMON_RESULT(VK_ERROR_FRAGMENTATION);
    GNOMON_RESULT(VK_ERROR_UNKNOWN);
    default:
      return fmt::format("VkResult {}", static_cast<int>(result));
  }
#undef GNOMON_RESULT
}

std::string remedyFor(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "choose smaller maps or images, or another device with --device";
    case VK_ERROR_DEVICE_LOST:
      return "the driver gave up: try a smaller job, or --device llvmpipe";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "install a Vulkan 1.3 driver: apt-get install mesa-vulkan-drivers";
    default:
      return "set GNOMON_VALIDATION=1 to see why, or try --device llvmpipe";
  }
}

}  // namespace

void throwVulkanError(VkResult result, const char* call) {
  // The macro hands over the whole expression; its name is enough for one line.
  const std::string expression = call;
  throw WorldError(fmt::format("{} failed: {}; {}", expression.substr(0, expression.find('(')), resultName(result),
                               remedyFor(result)));
}

std::shared_mutex& loaderLists() {
  static std::shared_mutex lists;
  return lists;
}

void destroyInstance(VkInstance instance, const VkAllocationCallbacks* allocator) {
  std::unique_lock alone(loaderLists());
  vkDestroyInstance(instance, allocator);
}

void destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
  std::unique_lock alone(loaderLists());
  vkDestroyDevice(device, allocator);
}

}  // namespace gnomon::gpu
