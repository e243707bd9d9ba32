#pragma once
// A small renderer: draws the room into depth, normals and triangles, and shades by a visibility image and fog that
// somebody else makes of them.

#include "room.h"
#include "vulkan_base.h"

constexpr uint32_t kSide = 512;  // pixels
constexpr VkFormat kVisibilityFormat = VK_FORMAT_R8_UNORM;
constexpr float kLampCandela = 40.0f;
constexpr VkFormat kFogFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

struct MeshBuffers {
  GpuBuffer vertices, indices;
};

class Renderer {
 public:
  Renderer(Gpu& gpu, const Room& room);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  VkCommandBuffer begin();
  void recordPicture(VkCommandBuffer commands);  // depth, normals, triangles; then shaders may read them
  void drawMap(VkCommandBuffer commands, const glm::mat4& clipFromWorld);  // depth, within a rendering
  void recordShading(VkCommandBuffer commands, const glm::vec3& lightW, float fogPerMetre);
  void recordReadback(VkCommandBuffer commands);  // picture, visibility and fog
  void submitAndWait(VkCommandBuffer commands);
  void stamp(VkCommandBuffer commands, uint32_t i);
  double milliseconds(uint32_t from, uint32_t to) const;

  glm::mat4 clipFromEye{0.0f};  // reversed depth, no far plane
  std::vector<MeshBuffers> meshes;
  GpuImage depth, normals, triangles, visibility, fog, picture;
  GpuBuffer pictureBytes, visibilityBytes, fogBytes;  // on the CPU

 private:
  void makePipelines();
  void drawRoom(VkCommandBuffer commands, const glm::mat4& clipFromWorld, bool culls);
  Gpu& gpu_;
  const Room& room_;
  GpuBuffer colors_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  VkQueryPool stamps_ = VK_NULL_HANDLE;
  VkPipelineLayout drawLayout_ = VK_NULL_HANDLE, shadeLayout_ = VK_NULL_HANDLE;
  VkPipeline draw_ = VK_NULL_HANDLE, map_ = VK_NULL_HANDLE, shade_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkDescriptorPool setPool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};
