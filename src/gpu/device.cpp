#include "gpu/device.h"

#include "base/check.h"
#include "base/error.h"
#include "gpu/features.h"
#include "gpu/pending_work.h"
#include "gpu/pipeline_cache.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace gnomon::gpu {

// Written by the validation layers, from whichever thread made the call.
struct Device::Messages {
  std::mutex mutex;
  std::vector<std::string> list;
  std::vector<std::string>* sink = nullptr;
};

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::string lowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool hasValidationLayer() {
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkEnumerateInstanceLayerProperties(&count, nullptr));
  std::vector<VkLayerProperties> layers(count);
  GNOMON_VK_CHECK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

bool hasDebugUtils() {
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GNOMON_VK_CHECK(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()));
  return std::any_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
  });
}

// `next` is what validation needs; null without it.
VkResult createInstance(bool validation, const void* next, std::vector<const char*> extensions,
                        Owned<VkInstance, destroyInstance>& instance) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "gnomon";
  application.apiVersion = VK_API_VERSION_1_3;
  if (hasDebugUtils()) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, next};
  info.pApplicationInfo = &application;
  info.enabledLayerCount = validation ? 1 : 0;
  info.ppEnabledLayerNames = &kValidationLayer;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkInstance handle = VK_NULL_HANDLE;
  const VkResult result = [&] {
    std::unique_lock alone(loaderLists());
    return vkCreateInstance(&info, nullptr, &handle);
  }();
  instance = Owned<VkInstance, destroyInstance>(handle);
  return result;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
  uint32_t count = 0;
  if (vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkPhysicalDevice> devices(count);
  GNOMON_VK_CHECK(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
  return devices;
}

std::string versionText(uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

DeviceInfo describe(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties core{};
  vkGetPhysicalDeviceProperties(device, &core);
  DeviceInfo info;
  info.name = core.deviceName;
  info.apiVersion = versionText(core.apiVersion);
  info.isCpu = core.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  info.timestampPeriod = core.limits.timestampPeriod;
  info.maxImageDimension2D = core.limits.maxImageDimension2D;
  info.maxImageLayers = core.limits.maxImageArrayLayers;
  info.maxPushConstantBytes = core.limits.maxPushConstantsSize;
  info.maxStorageBufferBytes = core.limits.maxStorageBufferRange;
  info.maxTexelBufferElements = core.limits.maxTexelBufferElements;
  if (core.apiVersion < VK_API_VERSION_1_3) return info;
  VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &v12};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
  vkGetPhysicalDeviceProperties2(device, &properties);
  info.driver = fmt::format("{} {}", v12.driverName, v12.driverInfo);
  info.maxAllocationBytes = v11.maxMemoryAllocationSize;
  return info;
}

// Discrete GPU, integrated, virtual, CPU; what cannot be told comes last.
int rank(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  switch (properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 3;
    default:
      return 4;
  }
}

struct Candidate {
  VkPhysicalDevice device = VK_NULL_HANDLE;
  Capabilities capabilities;
};

// The first device that will do, by name or by rank. Throws WorldError.
Candidate chooseDevice(VkInstance instance, const std::string& name) {
  std::vector<VkPhysicalDevice> devices = physicalDevices(instance);
  if (devices.empty()) throw WorldError("no Vulkan device; install a driver: apt-get install mesa-vulkan-drivers");
  std::vector<std::string> names;
  for (VkPhysicalDevice device : devices) names.push_back(fmt::format("'{}'", describe(device).name));
  if (!name.empty())
    std::erase_if(devices, [&](VkPhysicalDevice device) {
      return lowerCase(describe(device).name).find(lowerCase(name)) == std::string::npos;
    });
  if (devices.empty())
    throw WorldError(fmt::format("no Vulkan device is named '{}'; available: {}", name, fmt::join(names, ", ")));
  if (name.empty())
    std::stable_sort(devices.begin(), devices.end(),
                     [](VkPhysicalDevice a, VkPhysicalDevice b) { return rank(a) < rank(b); });

  std::string refusal;  // of the first, which a person would expect to be used
  for (VkPhysicalDevice device : devices) {
    Candidate candidate{device, queryCapabilities(device)};
    const std::vector<std::string> missing = missingRequirements(candidate.capabilities);
    if (missing.empty()) return candidate;
    if (refusal.empty())
      refusal = fmt::format(
          "device '{}' lacks {}; update its driver, or choose another with --device (apt-get install "
          "mesa-vulkan-drivers gives llvmpipe)",
          describe(device).name, fmt::join(missing, ", "));
  }
  throw WorldError(refusal);
}

// A family that draws and computes. Drawing families must compute by the specification, in some family at least.
uint32_t chooseQueueFamily(VkPhysicalDevice device, uint32_t& timestampValidBits) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (uint32_t i = 0; i < count; ++i) {
    if ((families[i].queueFlags & wanted) != wanted) continue;
    timestampValidBits = families[i].timestampValidBits;
    return i;
  }
  throw WorldError(fmt::format("device '{}' has no queue for both graphics and compute; choose another with --device",
                               describe(device).name));
}

template <typename Function>
Function load(VkDevice device, const char* name) {
  std::shared_lock beside(loaderLists());
  return reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
}

}  // namespace

// The steps of Device::create, in order; each fills members of `device`.
struct DeviceBuilder {
  Device& device;

  static VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& messages = *static_cast<Device::Messages*>(user);
    const std::string text = data->pMessage ? data->pMessage : "";
    std::lock_guard lock(messages.mutex);
    std::fprintf(stderr, "validation: %s\n", text.c_str());
    messages.list.push_back(text);
    if (messages.sink) messages.sink->push_back(text);
    return VK_FALSE;
  }

  VkDebugUtilsMessengerCreateInfoEXT messengerInfo() const {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // Not the performance messages: they object to GENERAL layouts, which are the house rule.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    info.pfnUserCallback = hear;
    info.pUserData = device.messages_.get();
    return info;
  }

  void makeInstance(bool validation, const std::vector<const char*>& extensions) {
    if (validation && !hasValidationLayer())
      throw WorldError(
          fmt::format("validation was asked for, but {} is not installed; apt-get install "
                      "vulkan-validationlayers, or unset GNOMON_VALIDATION",
                      kValidationLayer));
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    // In the instance's own chain the messenger also hears vkCreateInstance and vkDestroyInstance.
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo();
    messenger.pNext = &features;
    const VkResult result = createInstance(validation, validation ? &messenger : nullptr, extensions, device.instance_);
    if (result != VK_SUCCESS) throwVulkanError(result, "vkCreateInstance");
    if (!validation) return;
    messenger.pNext = nullptr;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(device.instance_.get(), "vkCreateDebugUtilsMessengerEXT"));
    GNOMON_CHECK(create != nullptr);
    GNOMON_VK_CHECK(create(device.instance_.get(), &messenger, nullptr, &device.messenger_));
  }

  void makeDevice(const std::string& name, const std::vector<const char*>& besides) {
    const Candidate chosen = chooseDevice(device.instance_.get(), name);
    for (const char* extension : besides)
      if (!chosen.capabilities.has(extension))
        throw WorldError(fmt::format("device '{}' lacks {}, so it cannot show a window; choose another with --device",
                                     describe(chosen.device).name, extension));
    device.physical_ = chosen.device;
    device.info_ = describe(chosen.device);
    device.queueFamily_ = chooseQueueFamily(chosen.device, device.info_.timestampValidBits);
    Features features = enabledFeatures(chosen.capabilities);
    device.info_.orderedAttachmentAccess = features.ordered.rasterizationOrderColorAttachmentAccess == VK_TRUE;
    device.info_.tessellation = features.core.features.tessellationShader == VK_TRUE;
    features.chain(chosen.capabilities.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME));

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = device.queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    std::vector<const char*> extensions = enabledExtensions(chosen.capabilities);
    extensions.insert(extensions.end(), besides.begin(), besides.end());
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice handle = VK_NULL_HANDLE;
    {
      std::unique_lock alone(loaderLists());
      GNOMON_VK_CHECK(vkCreateDevice(chosen.device, &info, nullptr, &handle));
    }
    device.device_ = Owned<VkDevice, destroyDevice>(handle);
    device.handle_ = handle;
  }

  void finish() {
    VkDevice handle = device.handle();
    if (!device.pending_) vkGetDeviceQueue(handle, device.queueFamily_, 0, &device.queue_);
    vkGetPhysicalDeviceMemoryProperties(device.physical_, &device.memory_);
    device.functions_ = {
        .pushDescriptorSet = load<PFN_vkCmdPushDescriptorSetKHR>(handle, "vkCmdPushDescriptorSetKHR"),
        .beginLabel = load<PFN_vkCmdBeginDebugUtilsLabelEXT>(handle, "vkCmdBeginDebugUtilsLabelEXT"),
        .endLabel = load<PFN_vkCmdEndDebugUtilsLabelEXT>(handle, "vkCmdEndDebugUtilsLabelEXT"),
        .setObjectName = load<PFN_vkSetDebugUtilsObjectNameEXT>(handle, "vkSetDebugUtilsObjectNameEXT"),
    };
    if (!device.pending_)
      device.pipelineCache_ = createPipelineCache(device.physical_, handle);
    else if (device.lentCache_ == VK_NULL_HANDLE)
      device.pipelineCache_ = createEmptyPipelineCache(handle);
  }
};

Device::Device() = default;

std::unique_ptr<Device> Device::create(const DeviceOptions& options) {
  std::unique_ptr<Device> device(new Device());
  device->messages_ = std::make_unique<Messages>();
  device->messages_->sink = options.messageSink;
  DeviceBuilder builder{*device};
  builder.makeInstance(options.validation || environment("GNOMON_VALIDATION") == "1", options.instanceExtensions);
  builder.makeDevice(options.name.empty() ? environment("GNOMON_DEVICE") : options.name, options.deviceExtensions);
  device->info_.mapsDeviceMemory = !options.hideDeviceMemory;
  builder.finish();
  return device;
}

std::unique_ptr<Device> Device::borrow(const BorrowedDevice& lent) {
  const std::vector<std::string> missing = missingRequirements(queryCapabilities(lent.physical));
  if (!missing.empty())
    throw WorldError(
        fmt::format("device '{}' lacks {}; choose another", describe(lent.physical).name, fmt::join(missing, ", ")));
  std::unique_ptr<Device> device(new Device());
  device->messages_ = std::make_unique<Messages>();
  device->physical_ = lent.physical;
  device->handle_ = lent.device;
  device->queueFamily_ = lent.queueFamily;
  device->info_ = describe(lent.physical);
  device->info_.orderedAttachmentAccess = lent.orderedAttachmentAccess;
  device->memorySource_ = lent.memory;
  device->lentCache_ = lent.pipelineCache;
  device->pending_ = std::make_unique<PendingWork>(*device);
  DeviceBuilder{*device}.finish();
  if (device->functions_.pushDescriptorSet == nullptr)
    throw WorldError(fmt::format("device '{}' was made without {}; enable it (gpu::enabledExtensions lists all)",
                                 device->info_.name, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME));
  return device;
}

// The messenger must outlive the VkDevice, whose destruction reports what was leaked; the instance's own
// chain then hears the rest.
Device::~Device() {
  if (device_) savePipelineCache(physical_, handle(), pipelineCache());
  { const auto cache = std::move(pipelineCache_); }
  { const auto device = std::move(device_); }
  if (!messenger_) return;
  const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_.get(), "vkDestroyDebugUtilsMessengerEXT"));
  destroy(instance_.get(), messenger_, nullptr);
}

const std::vector<std::string>& Device::validationMessages() const {
  return messages_->list;
}

std::vector<std::string> Device::takeValidationMessages() const {
  std::lock_guard lock(messages_->mutex);
  if (messages_->sink) messages_->sink->clear();
  return std::exchange(messages_->list, {});
}

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const {
  // The first of the best: Vulkan lists types with fewer needless properties earlier.
  std::optional<uint32_t> best;
  int bestCount = -1;
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
    if (!(typeBits & (1u << i)) || (flags & required) != required) continue;
    const int count = std::popcount(flags & preferred);
    if (count <= bestCount) continue;
    best = i;
    bestCount = count;
  }
  if (!best)
    throw WorldError(fmt::format("device '{}' has no memory type with properties {:#x}; choose another with --device",
                                 info_.name, required));
  return *best;
}

void Device::releaseStaging() const {
  if (pending_) pending_->releaseStaging();
}

void Device::nameObject(VkObjectType type, uint64_t object, const char* name) const {
  if (!functions_.setObjectName) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = name;
  std::shared_lock beside(loaderLists());
  GNOMON_VK_CHECK(functions_.setObjectName(handle(), &info));
}

std::vector<DeviceInfo> listDevices() {
  Owned<VkInstance, destroyInstance> instance;
  if (createInstance(false, nullptr, {}, instance) != VK_SUCCESS) return {};
  std::vector<DeviceInfo> devices;
  for (VkPhysicalDevice device : physicalDevices(instance.get())) devices.push_back(describe(device));
  return devices;
}

}  // namespace gnomon::gpu
