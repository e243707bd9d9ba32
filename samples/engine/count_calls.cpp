#include "count_calls.h"

#include <vulkan/vulkan.h>

#include <cstdlib>
#include <new>

#include <dlfcn.h>

Calls calls;

void* operator new(size_t size) {
  ++calls.heap;
  if (void* made = std::malloc(size)) return made;
  throw std::bad_alloc();
}
// Whoever asks by this form frees by those below.
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  ++calls.heap;
  return std::malloc(size);
}
void operator delete(void* at) noexcept {
  std::free(at);
}
void operator delete(void* at, size_t) noexcept {
  std::free(at);
}

void* operator new[](size_t size) {
  return operator new(size);
}
void* operator new[](size_t size, const std::nothrow_t& none) noexcept {
  return operator new(size, none);
}
void operator delete[](void* at) noexcept {
  std::free(at);
}
void operator delete[](void* at, size_t) noexcept {
  std::free(at);
}

// The loader's own, which ours stands before.
#define NEXT(name) static const auto next = reinterpret_cast<PFN_##name>(dlsym(RTLD_NEXT, #name))
#define COUNT_CREATE(name, Info, Handle)                                                                            \
  VKAPI_ATTR VkResult VKAPI_CALL name(VkDevice d, const Info* info, const VkAllocationCallbacks* a, Handle* made) { \
    NEXT(name);                                                                                                     \
    ++calls.objects;                                                                                                \
    return next(d, info, a, made);                                                                                  \
  }

extern "C" {
VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
  NEXT(vkQueueSubmit);
  ++calls.submits;
  return next(queue, count, infos, fence);
}
VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                              VkFence fence) {
  NEXT(vkQueueSubmit2);
  ++calls.submits;
  return next(queue, count, infos, fence);
}
VKAPI_ATTR VkResult VKAPI_CALL vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all,
                                               uint64_t timeout) {
  NEXT(vkWaitForFences);
  ++calls.waits;
  return next(device, count, fences, all, timeout);
}
VKAPI_ATTR VkResult VKAPI_CALL vkQueueWaitIdle(VkQueue queue) {
  NEXT(vkQueueWaitIdle);
  ++calls.waits;
  return next(queue);
}
VKAPI_ATTR VkResult VKAPI_CALL vkDeviceWaitIdle(VkDevice device) {
  NEXT(vkDeviceWaitIdle);
  ++calls.waits;
  return next(device);
}
VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                                const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  NEXT(vkAllocateMemory);
  ++calls.allocations;
  return next(device, info, allocator, memory);
}
VKAPI_ATTR VkResult VKAPI_CALL vkCreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                         const VkGraphicsPipelineCreateInfo* infos,
                                                         const VkAllocationCallbacks* allocator, VkPipeline* made) {
  NEXT(vkCreateGraphicsPipelines);
  ++calls.objects;
  return next(device, cache, count, infos, allocator, made);
}
VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                        const VkComputePipelineCreateInfo* infos,
                                                        const VkAllocationCallbacks* allocator, VkPipeline* made) {
  NEXT(vkCreateComputePipelines);
  ++calls.objects;
  return next(device, cache, count, infos, allocator, made);
}
COUNT_CREATE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
COUNT_CREATE(vkCreateBufferView, VkBufferViewCreateInfo, VkBufferView)
COUNT_CREATE(vkCreateImage, VkImageCreateInfo, VkImage)
COUNT_CREATE(vkCreateImageView, VkImageViewCreateInfo, VkImageView)
COUNT_CREATE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
COUNT_CREATE(vkCreateSampler, VkSamplerCreateInfo, VkSampler)
COUNT_CREATE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
COUNT_CREATE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
COUNT_CREATE(vkCreateRenderPass, VkRenderPassCreateInfo, VkRenderPass)
COUNT_CREATE(vkCreateFramebuffer, VkFramebufferCreateInfo, VkFramebuffer)
COUNT_CREATE(vkCreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
COUNT_CREATE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
COUNT_CREATE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
COUNT_CREATE(vkCreateFence, VkFenceCreateInfo, VkFence)
}
