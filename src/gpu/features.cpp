#include "gpu/features.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

struct Feature {
  const char* name;
  const char* reason;
  VkBool32& (*field)(Features&);
};

#define GNOMON_FEATURE(part, name, reason)                               \
  {                                                                      \
#name, reason, [](Features & f) -> VkBool32& { return f.part.name; } \
  }

const Feature kRequired[] = {
    GNOMON_FEATURE(core.features, geometryShader, "gl_PrimitiveID in fragment shaders"),
    GNOMON_FEATURE(core.features, depthClamp, "casters in front of the near plane"),
    GNOMON_FEATURE(core.features, independentBlend, "colour targets with different blending"),
    GNOMON_FEATURE(core.features, fragmentStoresAndAtomics, "storage buffers in fragment shaders"),
    GNOMON_FEATURE(core.features, vertexPipelineStoresAndAtomics, "storage buffers in vertex shaders"),
    GNOMON_FEATURE(core.features, shaderStorageImageExtendedFormats, "rg32f and r32f storage images"),
    GNOMON_FEATURE(core.features, shaderClipDistance, "the horizon of a paraboloid"),
    GNOMON_FEATURE(v11, multiview, "all layers of a map in one pass"),
    GNOMON_FEATURE(v11, shaderDrawParameters, "gl_DrawID and gl_BaseInstance"),
    GNOMON_FEATURE(v12, scalarBlockLayout, "structs shared with C++"),
    GNOMON_FEATURE(v12, hostQueryReset, "timestamps"),
    GNOMON_FEATURE(v13, dynamicRendering, "render passes"),
    GNOMON_FEATURE(v13, synchronization2, "barriers"),
    GNOMON_FEATURE(v13, maintenance4, "LocalSizeId, which glslang emits for Vulkan 1.3"),
};

const Feature kOptional[] = {
    GNOMON_FEATURE(core.features, tessellationShader, "tessellated paraboloid maps"),
    GNOMON_FEATURE(ordered, rasterizationOrderColorAttachmentAccess, "two depth layers in one pass"),
};

#undef GNOMON_FEATURE

const char* const kRequiredExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
const char* const kOptionalExtensions[] = {VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME};

}  // namespace

void Features::chain(bool withOrdered) {
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
  v13.pNext = withOrdered ? &ordered : nullptr;
}

bool Capabilities::has(const char* extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

Capabilities queryCapabilities(VkPhysicalDevice device) {
  Capabilities capabilities;
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  capabilities.apiVersion = properties.apiVersion;
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GNOMON_VK_CHECK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()));
  for (const VkExtensionProperties& extension : extensions) capabilities.extensions.push_back(extension.extensionName);
  // The 1.1, 1.2 and 1.3 structs may only be asked of a device that knows them.
  if (capabilities.apiVersion >= VK_API_VERSION_1_3) {
    capabilities.features.chain(capabilities.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME));
    vkGetPhysicalDeviceFeatures2(device, &capabilities.features.core);
  }
  return capabilities;
}

std::vector<std::string> missingRequirements(const Capabilities& capabilities) {
  if (capabilities.apiVersion < VK_API_VERSION_1_3)
    return {fmt::format("Vulkan 1.3 (it has {}.{})", VK_API_VERSION_MAJOR(capabilities.apiVersion),
                        VK_API_VERSION_MINOR(capabilities.apiVersion))};
  std::vector<std::string> missing;
  Features features = capabilities.features;
  for (const Feature& feature : kRequired)
    if (!feature.field(features)) missing.push_back(fmt::format("{} (for {})", feature.name, feature.reason));
  for (const char* extension : kRequiredExtensions)
    if (!capabilities.has(extension)) missing.push_back(extension);
  return missing;
}

namespace {

template <typename T>
void copyStruct(const VkBaseInStructure* from, T& to) {
  const void* next = to.pNext;
  to = *reinterpret_cast<const T*>(from);
  to.pNext = const_cast<void*>(next);
}

// A feature of a struct of its own, where the version's struct is not used.
template <typename T>
VkBool32 fieldOf(const VkBaseInStructure* from, VkBool32 T::*field) {
  return reinterpret_cast<const T*>(from)->*field;
}

Capabilities enabledBy(const VkDeviceCreateInfo& info) {
  Capabilities enabled;
  enabled.apiVersion = VK_API_VERSION_1_3;
  for (uint32_t i = 0; i < info.enabledExtensionCount; ++i)
    enabled.extensions.emplace_back(info.ppEnabledExtensionNames[i]);
  Features& f = enabled.features;
  if (info.pEnabledFeatures != nullptr) f.core.features = *info.pEnabledFeatures;
  for (auto* s = static_cast<const VkBaseInStructure*>(info.pNext); s != nullptr; s = s->pNext) {
    switch (s->sType) {
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2:
        copyStruct(s, f.core);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES:
        copyStruct(s, f.v11);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES:
        copyStruct(s, f.v12);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES:
        copyStruct(s, f.v13);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT:
        copyStruct(s, f.ordered);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES:
        f.v11.multiview = fieldOf(s, &VkPhysicalDeviceMultiviewFeatures::multiview);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_DRAW_PARAMETERS_FEATURES:
        f.v11.shaderDrawParameters = fieldOf(s, &VkPhysicalDeviceShaderDrawParametersFeatures::shaderDrawParameters);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES:
        f.v12.scalarBlockLayout = fieldOf(s, &VkPhysicalDeviceScalarBlockLayoutFeatures::scalarBlockLayout);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES:
        f.v12.hostQueryReset = fieldOf(s, &VkPhysicalDeviceHostQueryResetFeatures::hostQueryReset);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES:
        f.v13.dynamicRendering = fieldOf(s, &VkPhysicalDeviceDynamicRenderingFeatures::dynamicRendering);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES:
        f.v13.synchronization2 = fieldOf(s, &VkPhysicalDeviceSynchronization2Features::synchronization2);
        break;
      case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES:
        f.v13.maintenance4 = fieldOf(s, &VkPhysicalDeviceMaintenance4Features::maintenance4);
        break;
      default:
        break;
    }
  }
  return enabled;
}

}  // namespace

std::vector<std::string> notEnabled(const VkDeviceCreateInfo& info) {
  return missingRequirements(enabledBy(info));
}

bool enablesOrderedAccess(const VkDeviceCreateInfo& info) {
  const Capabilities enabled = enabledBy(info);
  return enabled.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME) &&
         enabled.features.ordered.rasterizationOrderColorAttachmentAccess == VK_TRUE;
}

Features enabledFeatures(const Capabilities& capabilities) {
  Features available = capabilities.features;
  Features enabled;
  for (const Feature& feature : kRequired) feature.field(enabled) = VK_TRUE;
  for (const Feature& feature : kOptional) feature.field(enabled) = feature.field(available);
  return enabled;
}

std::vector<const char*> enabledExtensions(const Capabilities& capabilities) {
  std::vector<const char*> extensions(std::begin(kRequiredExtensions), std::end(kRequiredExtensions));
  for (const char* extension : kOptionalExtensions)
    if (capabilities.has(extension)) extensions.push_back(extension);
  return extensions;
}

}  // namespace gnomon::gpu
