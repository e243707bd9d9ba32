#pragma once
// What Gnomon requires of a device: one list of features and one of extensions. Error messages name what is missing.

#include "gpu/vulkan.h"

#include <string>
#include <vector>

namespace gnomon::gpu {

// The feature structs as one chain. `query` fills them, `chain` links them for vkCreateDevice.
struct Features {
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT ordered{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT};

  // The `ordered` struct is linked only where the device has its extension.
  void chain(bool withOrdered);
};

// The device's Vulkan version, features and extensions, as far as Gnomon looks at them.
struct Capabilities {
  uint32_t apiVersion = 0;
  std::vector<std::string> extensions;
  Features features;

  bool has(const char* extension) const;
};

Capabilities queryCapabilities(VkPhysicalDevice device);

// Names of the required features and extensions that are missing; empty where the device will do.
std::vector<std::string> missingRequirements(const Capabilities& capabilities);

// The same of what a caller switches on when it makes its device; the device itself cannot be asked. Features of 1.1 to
// 1.3 are found in the structs of those versions, and in those of the extensions that became part of them.
std::vector<std::string> notEnabled(const VkDeviceCreateInfo& info);
// Whether it switches on two depth layers in one pass (DeviceInfo::orderedAttachmentAccess).
bool enablesOrderedAccess(const VkDeviceCreateInfo& info);

// What to switch on: everything required, and of the optional what the device has.
Features enabledFeatures(const Capabilities& capabilities);
std::vector<const char*> enabledExtensions(const Capabilities& capabilities);

}  // namespace gnomon::gpu
