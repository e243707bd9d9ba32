#pragma once
// The renderer's own Vulkan: an instance, a device, buffers and images. No word of Gnomon.

#include <vulkan/vulkan.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#define VK(call)                                                                      \
  do {                                                                                \
    if (const VkResult vkResult = (call); vkResult != VK_SUCCESS)                     \
      throw std::runtime_error(std::string(#call) + ": " + std::to_string(vkResult)); \
  } while (false)

struct Gpu {
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkQueue queue = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memory{};
  float nanosecondsPerTick = 1.0f;
  int complaints = 0;  // of the validation layers

  uint32_t memoryType(uint32_t bits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred = 0) const;
};
Gpu makeInstance(bool validation);
void makeDevice(Gpu& gpu, const VkDeviceCreateInfo& wanted);  // its queues are filled in
void destroy(Gpu& gpu);

struct GpuBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;
};
GpuBuffer makeBuffer(const Gpu& gpu, VkDeviceSize size, VkBufferUsageFlags usage, const void* contents = nullptr);

struct GpuImage {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};
GpuImage makeImage(const Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage);
void destroy(const Gpu& gpu, GpuBuffer& buffer);
void destroy(const Gpu& gpu, GpuImage& image);

VkShaderModule makeShader(const Gpu& gpu, const uint32_t* spirv, size_t bytes);

// A layout transition with its barrier: who wrote -> who reads.
struct Hop {
  VkPipelineStageFlags2 from;
  VkAccessFlags2 wrote;
  VkPipelineStageFlags2 to;
  VkAccessFlags2 reads;
};
void transition(VkCommandBuffer commands, const GpuImage& image, VkImageLayout before, VkImageLayout after, Hop hop);
