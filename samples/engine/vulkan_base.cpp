#include "vulkan_base.h"

#include <cstdio>

namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  std::fprintf(stderr, "%s\n", data->pMessage);
  ++*static_cast<int*>(user);
  return VK_FALSE;
}

int complaintCount = 0;

}  // namespace

uint32_t Gpu::memoryType(uint32_t bits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags wanted : {required | preferred, required})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((bits >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw std::runtime_error("no such memory");
}

Gpu makeInstance(bool validation) {
  Gpu gpu;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "a renderer of its own";
  application.apiVersion = VK_API_VERSION_1_3;
  const char* layer = "VK_LAYER_KHRONOS_validation";
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &synchronization;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, validation ? &features : nullptr};
  info.pApplicationInfo = &application;
  info.enabledLayerCount = info.enabledExtensionCount = validation ? 1 : 0;
  info.ppEnabledLayerNames = &layer;
  info.ppEnabledExtensionNames = &extension;
  VK(vkCreateInstance(&info, nullptr, &gpu.instance));
  if (validation) {
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = hear;
    messenger.pUserData = &complaintCount;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(gpu.instance, "vkCreateDebugUtilsMessengerEXT"));
    VK(create(gpu.instance, &messenger, nullptr, &gpu.messenger));
  }
  uint32_t count = 1;  // the first will do
  const VkResult found = vkEnumeratePhysicalDevices(gpu.instance, &count, &gpu.physical);
  if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || count == 0) throw std::runtime_error("no Vulkan device");
  vkGetPhysicalDeviceMemoryProperties(gpu.physical, &gpu.memory);
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(gpu.physical, &properties);
  gpu.nanosecondsPerTick = properties.limits.timestampPeriod;
  return gpu;
}

void makeDevice(Gpu& gpu, const VkDeviceCreateInfo& wanted) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical, &count, families.data());
  const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  while (gpu.family < count && (families[gpu.family].queueFlags & both) != both) ++gpu.family;
  if (gpu.family == count) throw std::runtime_error("no queue that draws and computes");
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = gpu.family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info = wanted;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  VK(vkCreateDevice(gpu.physical, &info, nullptr, &gpu.device));
  vkGetDeviceQueue(gpu.device, gpu.family, 0, &gpu.queue);
}

void destroy(Gpu& gpu) {
  vkDestroyDevice(gpu.device, nullptr);
  if (gpu.messenger) {
    const auto end = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(gpu.instance, "vkDestroyDebugUtilsMessengerEXT"));
    end(gpu.instance, gpu.messenger, nullptr);
  }
  vkDestroyInstance(gpu.instance, nullptr);
  gpu.complaints = complaintCount;
}

GpuBuffer makeBuffer(const Gpu& gpu, VkDeviceSize size, VkBufferUsageFlags usage, const void* contents) {
  GpuBuffer made;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = usage;
  VK(vkCreateBuffer(gpu.device, &info, nullptr, &made.buffer));
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(gpu.device, made.buffer, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex =
      gpu.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                     VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  VK(vkAllocateMemory(gpu.device, &allocate, nullptr, &made.memory));
  VK(vkBindBufferMemory(gpu.device, made.buffer, made.memory, 0));
  VK(vkMapMemory(gpu.device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.mapped));
  if (contents) std::memcpy(made.mapped, contents, size);
  return made;
}

GpuImage makeImage(const Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage) {
  GpuImage made{.format = format,
                .aspect = format == VK_FORMAT_D32_SFLOAT ? static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_DEPTH_BIT)
                                                         : static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_COLOR_BIT)};
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {width, height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  VK(vkCreateImage(gpu.device, &info, nullptr, &made.image));
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(gpu.device, made.image, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = gpu.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  VK(vkAllocateMemory(gpu.device, &allocate, nullptr, &made.memory));
  VK(vkBindImageMemory(gpu.device, made.image, made.memory, 0));
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = made.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {made.aspect, 0, 1, 0, 1};
  VK(vkCreateImageView(gpu.device, &view, nullptr, &made.view));
  return made;
}

void destroy(const Gpu& gpu, GpuBuffer& buffer) {
  vkDestroyBuffer(gpu.device, buffer.buffer, nullptr);
  vkFreeMemory(gpu.device, buffer.memory, nullptr);
}

void destroy(const Gpu& gpu, GpuImage& image) {
  vkDestroyImageView(gpu.device, image.view, nullptr);
  vkDestroyImage(gpu.device, image.image, nullptr);
  vkFreeMemory(gpu.device, image.memory, nullptr);
}

VkShaderModule makeShader(const Gpu& gpu, const uint32_t* spirv, size_t bytes) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = bytes;
  info.pCode = spirv;
  VkShaderModule module = VK_NULL_HANDLE;
  VK(vkCreateShaderModule(gpu.device, &info, nullptr, &module));
  return module;
}

void transition(VkCommandBuffer commands, const GpuImage& image, VkImageLayout before, VkImageLayout after, Hop hop) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = hop.from;
  barrier.srcAccessMask = hop.wrote;
  barrier.dstStageMask = hop.to;
  barrier.dstAccessMask = hop.reads;
  barrier.oldLayout = before;
  barrier.newLayout = after;
  barrier.image = image.image;
  barrier.subresourceRange = {image.aspect, 0, 1, 0, 1};
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}
