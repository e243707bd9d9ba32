#pragma once
// Puts pictures and the user interface into a window: a Vulkan device with a swapchain, apart from the device that
// draws the pictures, whose results arrive as bytes.

#include "base/image.h"
#include "gpu/resources.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;
struct ImDrawData;

namespace gnomon {

// A rectangle of the window or of a picture, pixels.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
};

class Presenter {
 public:
  static constexpr int kSlots = 3;  // pictures that can be shown at once
  // A part of a slot's picture, and where in the window it goes, stretched.
  struct Shown {
    int slot = 0;
    PixelRect from, to;
  };

  // `device`: part of a Vulkan device's name. Throws WorldError where it cannot show a window.
  Presenter(GLFWwindow* window, const std::string& device);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  // Three channels.
  void setPicture(int slot, const Image8& image);
  // Draws the pictures and the interface above them, and shows them. A window without an area shows nothing.
  void present(const std::vector<Shown>& pictures, ImDrawData* interface, bool keep);
  // What was shown last, where it was kept: three channels.
  const Image8& kept() const { return kept_; }
  size_t validationMessages() const { return device_->validationMessages().size(); }

 private:
  struct Frame;
  void createSwapchain();
  void destroySwapchain();
  void record(const std::vector<Shown>& pictures, ImDrawData* interface, uint32_t index, bool keep);

  GLFWwindow* window_;
  std::unique_ptr<gpu::Device> device_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_{};
  VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
  gpu::OwnedChild<VkRenderPass, vkDestroyRenderPass> renderPass_;
  gpu::OwnedChild<VkDescriptorPool, vkDestroyDescriptorPool> descriptors_;
  gpu::OwnedChild<VkCommandPool, vkDestroyCommandPool> pool_;
  gpu::OwnedChild<VkFence, vkDestroyFence> fence_;
  gpu::OwnedChild<VkSemaphore, vkDestroySemaphore> acquired_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  struct Target {
    VkImage image = VK_NULL_HANDLE;
    gpu::OwnedChild<VkImageView, vkDestroyImageView> view;
    gpu::OwnedChild<VkFramebuffer, vkDestroyFramebuffer> framebuffer;
    gpu::OwnedChild<VkSemaphore, vkDestroySemaphore> drawn;
  };
  std::vector<Target> targets_;
  struct Slot {
    gpu::Image image;
    gpu::Buffer staging;
    int width = 0, height = 0;
    bool changed = false;
  };
  std::array<Slot, kSlots> slots_;
  gpu::Buffer readback_;
  Image8 kept_;
};

}  // namespace gnomon
