#include "gpu/resources.h"

#include "base/check.h"
#include "base/error.h"
#include "gpu/commands.h"
#include "gpu/pending_work.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

// Large enough to amortize a submission, small enough not to double the memory of a large upload.
constexpr VkDeviceSize kStagingBytes = 16u << 20;

constexpr VkMemoryPropertyFlags kMappable =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

double mebibytes(VkDeviceSize bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

WorldError tooLarge(const char* name, VkDeviceSize bytes, const char* limit, VkDeviceSize most) {
  return WorldError(fmt::format("'{}' needs {:.1f} MiB, and {} is {:.1f} MiB; choose a smaller size", name,
                                mebibytes(bytes), limit, mebibytes(most)));
}

bool isOutOfMemory(VkResult result) {
  return result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

WorldError outOfMemory(const Device& device, const char* name, VkDeviceSize bytes) {
  return WorldError(fmt::format(
      "'{}' needs {:.1f} MiB of memory, which '{}' does not have free; choose smaller maps or images, or fewer of them",
      name, mebibytes(bytes), device.info().name));
}

void checkMade(const Device& device, VkResult result, const char* call, const char* name, VkDeviceSize bytes) {
  if (isOutOfMemory(result)) throw outOfMemory(device, name, bytes);
  if (result != VK_SUCCESS) throwVulkanError(result, call);
}

template <typename Handle>
void nameObject(const Device& device, VkObjectType type, Handle handle, const char* name) {
  device.nameObject(type, reinterpret_cast<uint64_t>(handle), name);
}

struct Allocation {
  OwnedMemory memory;
  bool mappable = false;
};

// Of whichever of the two is not null.
Allocation allocate(const Device& device, const char* name, const VkMemoryRequirements& needs, Memory kind,
                    VkBuffer buffer, VkImage image) {
  const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  if (MemorySource* source = device.memorySource()) {
    const bool host = kind == Memory::Readback;
    const MemoryBlock block =
        source->allocate({.name = name,
                          .needs = needs,
                          .required = host ? visible : 0,
                          .preferred = host ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                          .buffer = buffer,
                          .image = image});
    GNOMON_CHECK(block.memory != VK_NULL_HANDLE);
    GNOMON_CHECK(!host || block.mapped != nullptr);
    return {.memory = {device.handle(), source, block},
            .mappable = buffer != VK_NULL_HANDLE && block.mapped != nullptr};
  }
  if (needs.size > device.info().maxAllocationBytes)
    throw tooLarge(name, needs.size, "the device's largest allocation", device.info().maxAllocationBytes);
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  info.memoryTypeIndex = kind == Memory::Device
                             ? device.memoryType(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
                             : device.memoryType(needs.memoryTypeBits, visible, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  VkDeviceMemory handle = VK_NULL_HANDLE;
  checkMade(device, vkAllocateMemory(device.handle(), &info, nullptr, &handle), "vkAllocateMemory", name, needs.size);
  Allocation allocation{{device.handle(), nullptr, {.memory = handle}}, true};
  nameObject(device, VK_OBJECT_TYPE_DEVICE_MEMORY, handle, name);
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
  // Uncached memory is slow to read from the CPU, so Device memory of that kind goes through staging.
  if (kind == Memory::Device)
    allocation.mappable = device.info().mapsDeviceMemory &&
                          (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & kMappable) == kMappable;
  return allocation;
}

// Bytes of a texel, for the formats that Gnomon downloads; 0 for others.
VkDeviceSize texelBytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
      return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_D32_SFLOAT:
      return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SINT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SINT:
      return 16;
    default:
      return 0;
  }
}

VkDeviceSize packedBytes(const ImageDesc& desc) {
  return texelBytes(desc.format) * desc.width * desc.height * desc.layerCount;
}

VkImageCreateInfo imageInfo(const ImageDesc& desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  if (desc.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = desc.layerCount;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  return info;
}

// Throws WorldError when the device cannot have such an image at all.
void checkLimits(const Device& device, const ImageDesc& desc) {
  const DeviceInfo& limits = device.info();
  if (std::max(desc.width, desc.height) > limits.maxImageDimension2D)
    throw WorldError(
        fmt::format("'{}' is {} x {} texels, and the device's largest image is {} x {}; choose a "
                    "smaller size",
                    desc.name, desc.width, desc.height, limits.maxImageDimension2D, limits.maxImageDimension2D));
  if (desc.layerCount > limits.maxImageLayers)
    throw WorldError(fmt::format("'{}' has {} array layers, and the device's maximum is {}; choose fewer", desc.name,
                                 desc.layerCount, limits.maxImageLayers));
  const VkImageCreateInfo info = imageInfo(desc);
  VkImageFormatProperties properties{};
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(device.physical(), info.format, info.imageType,
                                                                   info.tiling, info.usage, info.flags, &properties);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED)
    throw WorldError(
        fmt::format("'{}': device '{}' has no images of VkFormat {} with usage {:#x}; choose another "
                    "device with --device",
                    desc.name, limits.name, static_cast<int>(info.format), info.usage));
  if (result != VK_SUCCESS) throwVulkanError(result, "vkGetPhysicalDeviceImageFormatProperties");
  if (packedBytes(desc) > properties.maxResourceSize)
    throw tooLarge(desc.name, packedBytes(desc), "the device's largest image", properties.maxResourceSize);
}

OwnedChild<VkImageView, vkDestroyImageView> createView(const Device& device, VkImage image, const ImageDesc& desc,
                                                       VkImageViewType type, VkImageSubresourceRange range,
                                                       VkComponentMapping components = {}) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image;
  info.viewType = type;
  info.format = desc.format;
  info.components = components;
  info.subresourceRange = range;
  VkImageView view = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateImageView(device.handle(), &info, nullptr, &view));
  nameObject(device, VK_OBJECT_TYPE_IMAGE_VIEW, view, desc.name);
  return {device.handle(), view};
}

}  // namespace

OwnedMemory::~OwnedMemory() {
  if (block_.memory == VK_NULL_HANDLE) return;
  if (source_)
    source_->release(block_);
  else
    vkFreeMemory(device_, block_.memory, nullptr);
}

PendingTicket::~PendingTicket() {
  if (work_) work_->forget(handle_);
}

void recordToGeneral(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, uint32_t layerCount) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, 1, 0, layerCount};
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

namespace {

void bringToGeneral(const Device& device, const Image& image) {
  if (device.pending() != nullptr) {
    device.pending()->bringToGeneral(image.handle(), image.aspect(), image.desc().layerCount);
    return;
  }
  Commands commands(device, image.desc().name);
  recordToGeneral(commands.handle(), image.handle(), image.aspect(), image.desc().layerCount);
  commands.submitAndWait();
}

}  // namespace

Buffer::Buffer(const Device& device, const BufferDesc& desc) : size_(desc.size == 0 ? 4 : desc.size) {
  GNOMON_CHECK(desc.name != nullptr);
  const DeviceInfo& limits = device.info();
  if ((desc.usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) && size_ > limits.maxStorageBufferBytes)
    throw tooLarge(desc.name, size_, "the device's largest storage buffer", limits.maxStorageBufferBytes);
  if (size_ > limits.maxAllocationBytes)
    throw tooLarge(desc.name, size_, "the device's largest allocation", limits.maxAllocationBytes);
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size_;
  info.usage = desc.usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer handle = VK_NULL_HANDLE;
  checkMade(device, vkCreateBuffer(device.handle(), &info, nullptr, &handle), "vkCreateBuffer", desc.name, size_);
  buffer_ = {device.handle(), handle};
  nameObject(device, VK_OBJECT_TYPE_BUFFER, handle, desc.name);
  ticket_ = {device.pending(), reinterpret_cast<uint64_t>(handle)};

  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.handle(), handle, &needs);
  Allocation allocation = allocate(device, desc.name, needs, desc.memory, handle, VK_NULL_HANDLE);
  memory_ = std::move(allocation.memory);
  const MemoryBlock& block = memory_.block();
  GNOMON_VK_CHECK(vkBindBufferMemory(device.handle(), handle, block.memory, block.offset));
  if (desc.texels != VK_FORMAT_UNDEFINED) {
    VkBufferViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    viewInfo.buffer = handle;
    viewInfo.format = desc.texels;
    viewInfo.range = VK_WHOLE_SIZE;
    VkBufferView view = VK_NULL_HANDLE;
    GNOMON_VK_CHECK(vkCreateBufferView(device.handle(), &viewInfo, nullptr, &view));
    view_ = {device.handle(), view};
    nameObject(device, VK_OBJECT_TYPE_BUFFER_VIEW, view, desc.name);
  }
  if (!allocation.mappable) return;
  void* mapped = block.mapped;
  if (mapped == nullptr) GNOMON_VK_CHECK(vkMapMemory(device.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &mapped));
  mapped_ = static_cast<std::byte*>(mapped);
}

Image::Image(const Device& device, const ImageDesc& desc) : desc_(desc) {
  GNOMON_CHECK(desc.name != nullptr);
  GNOMON_CHECK(desc.width > 0 && desc.height > 0 && desc.layerCount > 0);
  GNOMON_CHECK(desc.array || desc.layerCount == 1);
  GNOMON_CHECK(!desc.cube || desc.layerCount == 6);
  checkLimits(device, desc);
  const VkImageCreateInfo info = imageInfo(desc);
  VkImage handle = VK_NULL_HANDLE;
  checkMade(device, vkCreateImage(device.handle(), &info, nullptr, &handle), "vkCreateImage", desc.name,
            packedBytes(desc));
  image_ = {device.handle(), handle};
  nameObject(device, VK_OBJECT_TYPE_IMAGE, handle, desc.name);
  ticket_ = {device.pending(), reinterpret_cast<uint64_t>(handle)};

  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.handle(), handle, &needs);
  memory_ = allocate(device, desc.name, needs, Memory::Device, VK_NULL_HANDLE, handle).memory;
  GNOMON_VK_CHECK(vkBindImageMemory(device.handle(), handle, memory_.block().memory, memory_.block().offset));

  // Views exist to be bound; an image that is only copied has none.
  const VkImageUsageFlags viewUsages =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  if (desc.usage & viewUsages) {
    const VkImageViewType type = desc.cube    ? VK_IMAGE_VIEW_TYPE_CUBE
                                 : desc.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                              : VK_IMAGE_VIEW_TYPE_2D;
    view_ = createView(device, handle, desc, type, {aspect(), 0, 1, 0, desc.layerCount});
    for (uint32_t layer = 0; layer < desc.layerCount; ++layer)
      layerViews_.push_back(createView(device, handle, desc, VK_IMAGE_VIEW_TYPE_2D, {aspect(), 0, 1, layer, 1}));
  }
  bringToGeneral(device, *this);
}

Image::Image(const Device& device, const char* name, const Image& of, VkFormat format, int component)
    : component_({.of = of.handle(), .format = of.desc().format, .index = component}), desc_(of.desc()) {
  GNOMON_CHECK(!of.component());
  GNOMON_CHECK(component >= 0 && component < static_cast<int>(texelBytes(of.desc().format) / texelBytes(format)));
  const VkImageViewType type = desc_.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  desc_.name = name;
  const auto from = static_cast<VkComponentSwizzle>(VK_COMPONENT_SWIZZLE_R + component);
  view_ = createView(device, handle(), desc_, type, {aspect(), 0, 1, 0, desc_.layerCount}, {from, {}, {}, {}});
  desc_.format = format;
}

VkImageAspectFlags Image::aspect() const {
  const bool depth = desc_.format == VK_FORMAT_D32_SFLOAT || desc_.format == VK_FORMAT_D16_UNORM;
  return depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> bytes) {
  GNOMON_CHECK_LE(bytes.size(), buffer.size());
  if (bytes.empty()) return;
  if (buffer.mapped()) {
    std::memcpy(buffer.mapped(), bytes.data(), bytes.size());
    return;
  }
  if (device.pending() != nullptr) {
    device.pending()->upload(buffer.handle(), bytes);
    return;
  }
  const Buffer staging(device, {.name = "staging for upload",
                                .size = std::min<VkDeviceSize>(bytes.size(), kStagingBytes),
                                .usage = 0,
                                .memory = Memory::Readback});
  for (VkDeviceSize done = 0; done < bytes.size(); done += staging.size()) {
    const VkBufferCopy region{0, done, std::min<VkDeviceSize>(bytes.size() - done, staging.size())};
    std::memcpy(staging.mapped(), bytes.data() + done, region.size);
    Commands commands(device, "upload");
    vkCmdCopyBuffer(commands.handle(), staging.handle(), buffer.handle(), 1, &region);
    commands.submitAndWait();
  }
}

void download(const Device& device, const Buffer& buffer, std::span<std::byte> bytes) {
  GNOMON_CHECK_LE(bytes.size(), buffer.size());
  if (bytes.empty()) return;
  if (buffer.mapped()) {
    std::memcpy(bytes.data(), buffer.mapped(), bytes.size());
    return;
  }
  const Buffer staging(device, {.name = "staging for download",
                                .size = std::min<VkDeviceSize>(bytes.size(), kStagingBytes),
                                .usage = 0,
                                .memory = Memory::Readback});
  for (VkDeviceSize done = 0; done < bytes.size(); done += staging.size()) {
    const VkBufferCopy region{done, 0, std::min<VkDeviceSize>(bytes.size() - done, staging.size())};
    Commands commands(device, "download");
    vkCmdCopyBuffer(commands.handle(), buffer.handle(), staging.handle(), 1, &region);
    commands.submitAndWait();
    std::memcpy(bytes.data() + done, staging.mapped(), region.size);
  }
}

std::vector<std::byte> download(const Device& device, const Image& image) {
  const VkDeviceSize texel = texelBytes(image.desc().format);
  GNOMON_CHECK(texel > 0);  // it knows the format
  const VkDeviceSize size = packedBytes(image.desc());
  const VkDeviceSize stride = image.component() ? texelBytes(image.component()->format) : texel;
  const Buffer staging(
      device, {.name = "staging for download", .size = size / texel * stride, .usage = 0, .memory = Memory::Readback});
  Commands commands(device, "download image");
  commands.copy(image, staging);
  commands.submitAndWait();
  if (!image.component()) return {staging.mapped(), staging.mapped() + size};
  std::vector<std::byte> bytes(size);
  const std::byte* from = staging.mapped() + static_cast<size_t>(image.component()->index) * texel;
  for (size_t at = 0; at < size; at += texel, from += stride) std::memcpy(bytes.data() + at, from, texel);
  return bytes;
}

}  // namespace gnomon::gpu
