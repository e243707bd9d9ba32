#include "gpu/pipeline_cache.h"

#include "base/error.h"
#include "base/file.h"
#include "gpu/shader_compiler.h"

#include <cstring>
#include <filesystem>
#include <string>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

std::filesystem::path cacheFile(VkPhysicalDevice physical) {
  if (cacheDirectory().empty()) return {};
  VkPhysicalDeviceIDProperties id{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &id};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  std::string uuid;
  for (const uint8_t byte : id.deviceUUID) uuid += fmt::format("{:02x}", byte);
  return cacheDirectory() / fmt::format("pipelines-{}-{:08x}.bin", uuid, properties.properties.driverVersion);
}

// Empty where there is no file or the file cannot be read.
std::string readIfThere(const std::filesystem::path& path) {
  std::error_code failure;
  if (path.empty() || !std::filesystem::is_regular_file(path, failure)) return {};
  try {
    return readFile(path);
  } catch (const WorldError&) {
    return {};
  }
}

bool belongsTo(const std::string& bytes, VkPhysicalDevice physical) {
  VkPipelineCacheHeaderVersionOne header{};
  if (bytes.size() < sizeof(header)) return false;
  std::memcpy(&header, bytes.data(), sizeof(header));
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.headerSize <= bytes.size() &&
         header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
         std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

}  // namespace

OwnedChild<VkPipelineCache, vkDestroyPipelineCache> createPipelineCache(VkPhysicalDevice physical, VkDevice device) {
  std::string bytes = readIfThere(cacheFile(physical));
  if (!belongsTo(bytes, physical)) bytes.clear();
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = bytes.size();
  info.pInitialData = bytes.data();
  VkPipelineCache cache = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreatePipelineCache(device, &info, nullptr, &cache));
  return {device, cache};
}

OwnedChild<VkPipelineCache, vkDestroyPipelineCache> createEmptyPipelineCache(VkDevice device) {
  const VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreatePipelineCache(device, &info, nullptr, &cache));
  return {device, cache};
}

void savePipelineCache(VkPhysicalDevice physical, VkDevice device, VkPipelineCache cache) noexcept {
  try {
    const std::filesystem::path path = cacheFile(physical);
    size_t size = 0;
    if (path.empty() || vkGetPipelineCacheData(device, cache, &size, nullptr) != VK_SUCCESS) return;
    std::string bytes(size, '\0');
    if (vkGetPipelineCacheData(device, cache, &size, bytes.data()) != VK_SUCCESS) return;
    bytes.resize(size);
    if (bytes != readIfThere(path)) writeTextFile(path, bytes);
  } catch (const std::exception&) {
    // A cache is a convenience: a full disk or a read-only home must not fail the work that is already done.
  }
}

}  // namespace gnomon::gpu
