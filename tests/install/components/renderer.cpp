// Makes on a device of its own what one component offers; USES_shadow, USES_planar and so on says which.
#if defined(USES_media)
#include "vsv/media/embedded_fog.h"
#define USES_vsv
#endif
#if defined(USES_vsv)
#include "vsv/embedded_volume.h"
#define USES_omni
#endif
#if defined(USES_omni)
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#endif
#if defined(USES_planar)
#include "planar/planar_map.h"
#endif
#include "base/version.h"
#include "gpu/features.h"
#include "shadow/embedded_shadow.h"

#if GNOMON_VERSION_MAJOR != 0 || GNOMON_VERSION_MINOR < 1
#error "written for Gnomon 0.1"
#endif

#if defined(VULKAN_HPP) || defined(VULKAN_HPP_NAMESPACE) || defined(OPENVDB_VERSION_NAME) || \
    defined(NLOHMANN_JSON_VERSION_MAJOR) || defined(TINYGLTF_MODE_DEFAULT)
#error "a public header brings Vulkan-Hpp, OpenVDB, JSON or tinygltf"
#endif

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

void makeAll(const gpu::Device& device) {
  const BiasMethod& bias = findBias("adaptive");
  const LightModel light;
  const LentGeometry nothing(device, {.meshes = {},
                                      .instances = {},
                                      .tables = LentTables::Triangles,
                                      .sceneBoundsW = {glm::vec3(-1.0f), glm::vec3(1.0f)}});
#if defined(USES_omni)
  const FittedMap fit = makeCubeMap(light.positionW, CubeDepth::Hyperbolic, 0.1, 10.0, 64, 1.0f);
#elif defined(USES_planar)
  const FittedMap fit = makeSpotMap({.type = LightType::Spot, .directionW = {0, 0, -1}, .outerConeRad = 0.5},
                                    {.boundsW = {glm::vec3(-1.0f), glm::vec3(1.0f)}, .side = 64});
#else
  FittedMap fit;  // one that looks along -z
  fit.frame = {.originW = {}, .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}};
  fit.map = {.kind = glsl::kMapPlanar, .sliceCount = 1, .width = 64, .height = 64, .sceneScale = 1.0f};
  const glm::mat4 clip(glm::vec4(1, 0, 0, 0), glm::vec4(0, -1, 0, 0), glm::vec4(0, 0, -1.01f, -1),
                       glm::vec4(0, 0, -0.101f, 0));
  fit.map.mapSlices[0] = {clip, glm::inverse(clip)};
#endif
  const EmbeddedShadow shadow(
      device, nothing,
      {.fit = fit, .light = light, .bias = &bias, .params = defaultBiasParams(bias, 1.0f), .width = 64, .height = 64});
  std::printf("%d slices", shadow.map().sliceCount());
#if defined(USES_vsv)
  glm::mat4 projection(0.0f);
  projection[0][0] = 1.0f, projection[1][1] = -1.0f, projection[2][3] = -1.0f, projection[3][2] = 0.1f;
  glm::mat4 eye(1.0f);
  eye[3] = glm::vec4(0, 0, 5, 1);
  const FittedMap columns =
      makeVolume(light.positionW, cameraOf(eye, projection, 64, 64), {glm::vec3(-1.0f), glm::vec3(1.0f)},
                 {.alpha = 64, .theta = 64, .phi = 128}, VolumeFit::View);
  const EmbeddedVolume volume(device, nothing,
                              {.columns = columns,
                               .light = light,
                               .bias = &bias,
                               .params = defaultBiasParams(bias, 1.0f),
                               .width = 64,
                               .height = 64});
  std::printf(", %d columns", volume.volume().grid().thetaCount * volume.volume().grid().phiCount);
#endif
#if defined(USES_media)
  const EmbeddedFog fog(device, volume, {.width = 64, .height = 64});
  std::printf(", fog");
#endif
  std::printf("\n");
}

VkInstance makeInstance() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  VkInstance instance = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateInstance(&info, nullptr, &instance));
  return instance;
}

}  // namespace

int main() {
  try {
    const VkInstance instance = makeInstance();
    uint32_t count = 1;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    const gpu::Capabilities capabilities = gpu::queryCapabilities(physical);
    gpu::Features features = gpu::enabledFeatures(capabilities);
    features.chain(capabilities.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME));
    const std::vector<const char*> extensions = gpu::enabledExtensions(capabilities);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    GNOMON_VK_CHECK(vkCreateDevice(physical, &info, nullptr, &device));
    makeAll(*gpu::Device::borrow({.instance = instance,
                                  .physical = physical,
                                  .device = device,
                                  .orderedAttachmentAccess = gpu::enablesOrderedAccess(info)}));
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
