#pragma once
// The driver's compiled pipelines, kept in cacheDirectory() under the device and its driver version.
//
// lavapipe's cache is an empty header; what makes its second start fast is Mesa's own disk cache
// (MESA_SHADER_CACHE_DIR), which needs nothing from us. Other drivers rely on this one.

#include "gpu/vulkan.h"

namespace gnomon::gpu {

// Starts from the file when it belongs to this device and driver, else empty; file trouble is passed over.
OwnedChild<VkPipelineCache, vkDestroyPipelineCache> createPipelineCache(VkPhysicalDevice physical, VkDevice device);

// Of a borrowed device: no file.
OwnedChild<VkPipelineCache, vkDestroyPipelineCache> createEmptyPipelineCache(VkDevice device);

// Writes the file when its content would change; trouble is passed over.
void savePipelineCache(VkPhysicalDevice physical, VkDevice device, VkPipelineCache cache) noexcept;

}  // namespace gnomon::gpu
