#pragma once
// The Vulkan 1.3 device: one instance, one queue, the features Gnomon needs, and the messages of the validation layers.
//
// Choice: --device NAME takes the first device whose name contains NAME (case ignored); without it the first discrete
// GPU, then integrated, then a CPU device (lavapipe). GNOMON_DEVICE in the environment acts as --device.

#include "gpu/memory_source.h"
#include "gpu/vulkan.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon::gpu {

struct DeviceOptions {
  std::string name;         // part of a device name; empty chooses
  bool validation = false;  // also synchronization validation; or GNOMON_VALIDATION=1 in the environment
  // Also receives every message, those about objects that outlive the device too; must outlive the device.
  std::vector<std::string>* messageSink = nullptr;
  // Hides from the CPU what a discrete GPU would hide, so that lavapipe takes the staging path too: for tests.
  bool hideDeviceMemory = false;
  // Of whoever shows pictures on a screen: what a window system needs beside Gnomon's own. A device without the latter
  // is refused by name.
  std::vector<const char*> instanceExtensions = {}, deviceExtensions = {};
};

struct DeviceInfo {
  std::string name;
  std::string driver;      // name and version text of the driver
  std::string apiVersion;  // "1.3.230"
  bool isCpu = false;
  float timestampPeriod = 1.0f;     // nanoseconds a tick
  uint32_t timestampValidBits = 0;  // 0: the queue has no timestamps
  uint32_t maxImageDimension2D = 0;
  uint32_t maxImageLayers = 0;
  uint32_t maxPushConstantBytes = 0;
  uint64_t maxStorageBufferBytes = 0;
  uint32_t maxTexelBufferElements = 0;
  uint64_t maxAllocationBytes = 0;
  bool mapsDeviceMemory = true;  // where the driver offers it
  bool tessellation = false;
  bool orderedAttachmentAccess = false;  // VK_EXT_rasterization_order_attachment_access, colour
};

// Entry points that the loader does not export; the debug ones are null where there is no VK_EXT_debug_utils.
struct DeviceFunctions {
  PFN_vkCmdPushDescriptorSetKHR pushDescriptorSet = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;
};

// A device that somebody else made and keeps. It has what missingRequirements() and notEnabled() (features.h) ask for,
// and outlives what is made of it.
struct BorrowedDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;  // of the command buffers; draws and computes
  // Its optional features, as far as they are switched on.
  bool orderedAttachmentAccess = false;
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;  // none: one that is not kept
  MemorySource* memory = nullptr;                  // none: vkAllocateMemory, once a resource
};

class PendingWork;

// Submissions are not synchronized: one thread at a time.
class Device {
 public:
  // Throws WorldError: no device, none of that name (lists them), or a required feature is missing (names it).
  static std::unique_ptr<Device> create(const DeviceOptions& options);
  // Nothing is ever submitted to it: what resources need done on a queue (layouts, first contents) waits in pending().
  // Throws WorldError where it lacks something required (names it).
  static std::unique_ptr<Device> borrow(const BorrowedDevice& lent);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return info_; }
  VkDevice handle() const { return handle_; }
  VkInstance instance() const { return instance_.get(); }  // null of a borrowed one
  VkPhysicalDevice physical() const { return physical_; }
  VkQueue queue() const { return queue_; }
  uint32_t queueFamily() const { return queueFamily_; }
  VkPipelineCache pipelineCache() const { return lentCache_ ? lentCache_ : pipelineCache_.get(); }
  MemorySource* memorySource() const { return memorySource_; }
  PendingWork* pending() const { return pending_.get(); }  // null but for a borrowed device
  // Of a borrowed device: frees what large uploads took, once it is done with the command buffer that did them.
  void releaseStaging() const;
  const DeviceFunctions& functions() const { return functions_; }

  // Every warning and error of the validation layers so far. Tests fail on any.
  const std::vector<std::string>& validationMessages() const;
  // Empties that list: a test that provoked a message on purpose takes it away.
  std::vector<std::string> takeValidationMessages() const;

  // A memory type with the wanted properties; falls back to fewer of the preferred ones. Throws WorldError.
  uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const;

  void nameObject(VkObjectType type, uint64_t handle, const char* name) const;

 private:
  Device();
  struct Messages;
  std::unique_ptr<Messages> messages_;  // first, so that it hears the instance's end
  Owned<VkInstance, destroyInstance> instance_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  DeviceInfo info_;
  Owned<VkDevice, destroyDevice> device_;  // empty where it is borrowed
  VkDevice handle_ = VK_NULL_HANDLE;
  MemorySource* memorySource_ = nullptr;
  std::unique_ptr<PendingWork> pending_;
  VkPipelineCache lentCache_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queueFamily_ = 0;
  OwnedChild<VkPipelineCache, vkDestroyPipelineCache> pipelineCache_;
  VkPhysicalDeviceMemoryProperties memory_{};
  DeviceFunctions functions_;

  friend struct DeviceBuilder;
};

// Names of all devices, in the order Vulkan lists them; empty where there is no driver.
std::vector<DeviceInfo> listDevices();

}  // namespace gnomon::gpu
