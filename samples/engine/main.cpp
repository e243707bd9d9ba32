// A renderer of its own (plain Vulkan: vulkan_base.h, renderer.h, room.h) that adds Gnomon's shadows: everything that
// Gnomon needs of it is in this file. docs/embed.md walks through it.
//
//   engine [--validation] FOLDER
//
// Writes FOLDER/room.gltf, the scene for `gnomon compare`, and of each method a picture and the visibility of each
// pixel (512 x 512 bytes, 255 lit; of fog the scattered light, too, as 16-bit floats), and prints what it costs.

#include "count_calls.h"
#include "renderer.h"

#include "gpu/features.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "shadow/embedded_shadow.h"
#include "vsv/media/embedded_fog.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>

#include <png.h>

namespace {

constexpr int kMapSide = 512;               // texels
constexpr double kNear = 0.1, kFar = 12.0;  // metres: the ends of depth
constexpr float kFogPerMetre = 0.06f;
constexpr int kFrames = 4;  // the last one's light stands where room.gltf has it

enum class Kind { Cube, Paraboloid, Volume };
struct Method {
  const char* name;
  Kind kind;
  const char* bias;
  gnomon::ReceiverKind receivers;
  bool drawsItself = false;  // the renderer draws the map
};
constexpr Method kMethods[] = {
    {"cube_adaptive_depth", Kind::Cube, "adaptive", gnomon::ReceiverKind::Depth},
    {"cube_adaptive_own_draws", Kind::Cube, "adaptive", gnomon::ReceiverKind::Depth, true},
    {"cube_adaptive", Kind::Cube, "adaptive", gnomon::ReceiverKind::Triangles},
    {"cube_dual", Kind::Cube, "dual", gnomon::ReceiverKind::Triangles},  // two depth layers
    {"cube_witness", Kind::Cube, "witness", gnomon::ReceiverKind::Triangles},
    {"paraboloid_adaptive", Kind::Paraboloid, "adaptive", gnomon::ReceiverKind::Triangles},
    {"volume_fog", Kind::Volume, "adaptive", gnomon::ReceiverKind::Triangles},
};

// [embed: memory]
// Gnomon's buffers and images share blocks of the renderer's, which it maps for the CPU where Gnomon asks.
class Blocks final : public gnomon::gpu::MemorySource {
 public:
  explicit Blocks(const Gpu& gpu) : gpu_(gpu) {}
  ~Blocks() {
    for (const Block& block : blocks_) vkFreeMemory(gpu_.device, block.memory, nullptr);
  }

  gnomon::gpu::MemoryBlock allocate(const gnomon::gpu::MemoryRequest& request) override {
    const uint32_t type = gpu_.memoryType(request.needs.memoryTypeBits, request.required, request.preferred);
    const bool mapped = (request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    const auto fits = [&](const Block& block) {
      return block.type == type && (block.mapped != nullptr) == mapped && !block.image == !request.image &&
             aligned(block.used, request) + request.needs.size <= block.size;
    };
    auto found = std::find_if(blocks_.begin(), blocks_.end(), fits);
    if (found == blocks_.end()) found = blocks_.insert(blocks_.end(), makeBlock(type, mapped, request));
    const VkDeviceSize offset = aligned(found->used, request);
    found->used = offset + request.needs.size;
    return {.memory = found->memory,
            .offset = offset,
            .mapped = found->mapped ? static_cast<char*>(found->mapped) + offset : nullptr};
  }
  void release(const gnomon::gpu::MemoryBlock&) noexcept override {}  // all at once, in the end
                                                                      // [end]

 private:
  struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0, used = 0;
    uint32_t type = 0;
    bool image = false;
    void* mapped = nullptr;
  };
  static VkDeviceSize aligned(VkDeviceSize at, const gnomon::gpu::MemoryRequest& request) {
    return (at + request.needs.alignment - 1) / request.needs.alignment * request.needs.alignment;
  }
  Block makeBlock(uint32_t type, bool mapped, const gnomon::gpu::MemoryRequest& request) {
    Block block{.size = std::max<VkDeviceSize>(request.needs.size, 32u << 20),
                .type = type,
                .image = request.image != VK_NULL_HANDLE};
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = block.size;
    info.memoryTypeIndex = type;
    VK(vkAllocateMemory(gpu_.device, &info, nullptr, &block.memory));
    if (mapped) VK(vkMapMemory(gpu_.device, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped));
    return block;
  }
  const Gpu& gpu_;
  std::vector<Block> blocks_;
};

// What biases that follow surfaces are given beside a mesh's buffers.
struct CpuMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> triangles;
};

// [embed: geometry]
std::vector<gnomon::LentMesh> lentMeshes(const Room& room, const Renderer& renderer, const std::vector<CpuMesh>& cpu) {
  std::vector<gnomon::LentMesh> lent;
  for (size_t i = 0; i < room.meshes.size(); ++i) {
    const RoomMesh& mesh = room.meshes[i];
    gnomon::Bounds bounds{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
    for (const Vertex& vertex : mesh.vertices) {
      bounds.lower = glm::min(bounds.lower, vertex.position);
      bounds.upper = glm::max(bounds.upper, vertex.position);
    }
    lent.push_back({.vertices = renderer.meshes[i].vertices.buffer,
                    .positionFormat = VK_FORMAT_R32G32B32_SFLOAT,
                    .vertexStride = sizeof(Vertex),
                    .vertexCount = static_cast<uint32_t>(mesh.vertices.size()),
                    .indices = renderer.meshes[i].indices.buffer,
                    .indexType = VK_INDEX_TYPE_UINT16,
                    .indexCount = static_cast<uint32_t>(mesh.indices.size()),
                    .bounds = bounds,
                    .solid = mesh.closed,
                    .positions = cpu[i].positions,
                    .triangles = cpu[i].triangles});
  }
  return lent;
}
// [end]

void writeBytes(const std::filesystem::path& path, const void* data, size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void writePicture(const std::filesystem::path& path, const void* rgba) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = kSide;
  image.format = PNG_FORMAT_RGBA;
  if (png_image_write_to_file(&image, path.c_str(), 0, rgba, 0, nullptr) == 0)
    throw std::runtime_error("cannot write " + path.string());
}

struct Cost {
  double mapMs = 0.0, lookUpMs = 0.0, recordMs = 0.0;
  Calls calls;  // of Gnomon, in a steady frame
};

gnomon::LentTables tablesFor(const Method& method, const gnomon::BiasMethod& bias) {
  if (bias.knowsSurfaces()) return gnomon::LentTables::Surfaces;
  const bool fromDepth = method.kind == Kind::Cube && method.receivers == gnomon::ReceiverKind::Depth;
  return fromDepth ? gnomon::LentTables::None : gnomon::LentTables::Triangles;
}

// Several frames around what Gnomon records, under a lamp that moves, and what that costs.
template <typename Record>
Cost runFrames(Renderer& renderer, const Room& room, float fogPerMetre, Record record) {
  Cost cost;
  for (int frame = 0; frame < kFrames; ++frame) {
    const float swing = 0.2f * static_cast<float>(kFrames - 1 - frame);
    const glm::dvec3 lightW(room.lightW + glm::vec3(swing, 0.0f, 0.0f));
    const VkCommandBuffer commands = renderer.begin();
    renderer.recordPicture(commands);
    const Calls before = calls;
    const auto start = std::chrono::steady_clock::now();
    renderer.stamp(commands, 0);
    record(commands, lightW, frame);
    renderer.stamp(commands, 2);
    const auto end = std::chrono::steady_clock::now();
    if (frame > 0)
      cost.calls = {calls.submits - before.submits, calls.waits - before.waits, calls.allocations - before.allocations,
                    calls.objects - before.objects, calls.heap - before.heap};
    renderer.recordShading(commands, glm::vec3(lightW), fogPerMetre);
    if (frame == kFrames - 1) renderer.recordReadback(commands);
    renderer.submitAndWait(commands);
    cost.mapMs = renderer.milliseconds(0, 1);
    cost.lookUpMs = renderer.milliseconds(1, 2);
    cost.recordMs = std::chrono::duration<double, std::milli>(end - start).count();
  }
  return cost;
}

Cost run(const gnomon::gpu::Device& device, Renderer& renderer, const Room& room, const Method& method) {
  std::vector<CpuMesh> cpu(room.meshes.size());
  for (size_t i = 0; i < cpu.size(); ++i) {
    for (const Vertex& vertex : room.meshes[i].vertices) cpu[i].positions.push_back(vertex.position);
    cpu[i].triangles.assign(room.meshes[i].indices.begin(), room.meshes[i].indices.end());
  }
  const std::vector<gnomon::LentMesh> meshes = lentMeshes(room, renderer, cpu);
  const gnomon::BiasMethod& bias = gnomon::findBias(method.bias);
  // [embed: instances]
  std::vector<gnomon::LentInstance> instances;  // none where the renderer draws the map
  for (const RoomInstance& instance : method.drawsItself ? std::vector<RoomInstance>() : room.instances)
    instances.push_back({.mesh = instance.mesh, .worldFromMesh = instance.worldFromMesh});
  const gnomon::Bounds bounds{room.lower, room.upper};
  gnomon::LentGeometry geometry(
      device, {.meshes = meshes, .instances = instances, .tables = tablesFor(method, bias), .sceneBoundsW = bounds});
  // [end]
  const auto recordOnce = [&](VkCommandBuffer commands, int frame) {
    // [embed: tables]
    if (frame == 0 && geometry.tables() != gnomon::LentTables::None) geometry.recordTables(commands);
    // [end]
  };
  // [embed: receivers]
  const glm::mat4& projection = renderer.clipFromEye;
  const gnomon::ReceiverPicture receivers =
      method.receivers == gnomon::ReceiverKind::Depth
          ? gnomon::ReceiverPicture::ofDepth(
                {.depth = {renderer.depth.view},
                 .normals = {renderer.normals.view},
                 .meaning = gnomon::depthMeaning(projection, 0.0f, gnomon::glsl::kReceiverNormalsSigned)})
          : gnomon::ReceiverPicture::ofTriangles({renderer.triangles.view});
  const gnomon::glsl::CameraView camera = gnomon::cameraOf(room.worldFromEye, projection, kSide, kSide);
  // [end]
  const glm::dvec3 lampW(room.lightW);
  const auto params = gnomon::defaultBiasParams(bias, bounds.diagonal());

  if (method.kind == Kind::Volume) {
    // [embed: volume]
    const auto volumeAt = [&](const glm::dvec3& lightW) {
      return gnomon::makeVolume(lightW, camera, bounds, {.alpha = 512, .theta = 512, .phi = 512},
                                gnomon::VolumeFit::View);
    };
    gnomon::EmbeddedVolume volume(device, geometry,
                                  {.columns = volumeAt(lampW),
                                   .light = {.positionW = lampW},
                                   .bias = &bias,
                                   .params = params,
                                   .width = kSide,
                                   .height = kSide,
                                   .receivers = method.receivers,
                                   .visibility = kVisibilityFormat});
    gnomon::EmbeddedFog fog(device, volume,
                            {.width = kSide, .height = kSide, .receivers = method.receivers, .scattered = kFogFormat});
    const gnomon::glsl::Medium medium{.sigmaS = glm::vec3(kFogPerMetre), .sigmaA = {}, .g = 0.2f, .reach = 20.0f};
    // [end]
    return runFrames(renderer, room, kFogPerMetre, [&](VkCommandBuffer commands, const glm::dvec3& lightW, int frame) {
      recordOnce(commands, frame);
      // [embed: volume frame]
      volume.recordView(commands, volumeAt(lightW), {.positionW = lightW});
      volume.recordVolume(commands);
      renderer.stamp(commands, 1);
      volume.recordVisibility(commands, camera, receivers, renderer.visibility.view);
      fog.record(commands, volume, camera, receivers, medium,
                 {.positionW = lightW, .intensity = glm::vec3(kLampCandela)}, renderer.fog.view);
      // [end]
    });
  }

  // [embed: shadow]
  const auto mapAt = [&](const glm::dvec3& lightW) {
    return method.kind == Kind::Cube
               ? gnomon::makeCubeMap(lightW, gnomon::CubeDepth::Hyperbolic, kNear, kFar, kMapSide, bounds.diagonal())
               : gnomon::makeParaboloidMap(lightW, glm::dvec3(0, -1, 0), gnomon::ParaboloidRaster::Exact, kNear, kFar,
                                           kMapSide, bounds.diagonal());
  };
  gnomon::EmbeddedShadow shadow(device, geometry,
                                {.fit = mapAt(lampW),
                                 .light = {.positionW = lampW},
                                 .bias = &bias,
                                 .params = params,
                                 .width = kSide,
                                 .height = kSide,
                                 .receivers = method.receivers,
                                 .visibility = kVisibilityFormat});
  // [end]
  return runFrames(renderer, room, 0.0f, [&](VkCommandBuffer commands, const glm::dvec3& lightW, int frame) {
    recordOnce(commands, frame);
    // [embed: frame]
    shadow.recordLight(commands, mapAt(lightW), {.positionW = lightW});
    if (method.drawsItself)
      shadow.recordMap(commands, [&](VkCommandBuffer into, const gnomon::SliceToDraw& slice) {
        renderer.drawMap(into, slice.clipFromWorld);
      });
    else
      shadow.recordMap(commands);
    renderer.stamp(commands, 1);
    shadow.recordVisibility(commands, camera, receivers, renderer.visibility.view);
    // [end]
  });
}

int runAll(bool validation, const std::filesystem::path& folder) {
  Gpu gpu = makeInstance(validation);
  // [embed: device]
  const gnomon::gpu::Capabilities capabilities = gnomon::gpu::queryCapabilities(gpu.physical);
  for (const std::string& missing : gnomon::gpu::missingRequirements(capabilities))
    throw std::runtime_error("the device lacks " + missing);
  gnomon::gpu::Features features = gnomon::gpu::enabledFeatures(capabilities);  // and the renderer's own
  features.chain(capabilities.has(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME));
  const std::vector<const char*> extensions = gnomon::gpu::enabledExtensions(capabilities);
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  for (const std::string& missing : gnomon::gpu::notEnabled(info)) throw std::runtime_error("not enabled: " + missing);
  makeDevice(gpu, info);
  // [end]
  std::filesystem::create_directories(folder);
  const Room room = makeRoom();
  const std::string gltf = gltfOf(room);
  writeBytes(folder / "room.gltf", gltf.data(), gltf.size());
  {
    Blocks blocks(gpu);
    Renderer renderer(gpu, room);
    // [embed: borrow]
    const std::unique_ptr<gnomon::gpu::Device> device =
        gnomon::gpu::Device::borrow({.instance = gpu.instance,
                                     .physical = gpu.physical,
                                     .device = gpu.device,
                                     .queueFamily = gpu.family,
                                     .orderedAttachmentAccess = gnomon::gpu::enablesOrderedAccess(info),
                                     .memory = &blocks});
    // [end]
    std::printf("%-24s %8s %8s %8s %8s %8s %7s %5s %6s %7s %5s\n", "method", "lit", "shadow", "map ms", "look ms",
                "rec ms", "submits", "waits", "allocs", "objects", "heap");
    for (const Method& method : kMethods) {
      const Cost cost = run(*device, renderer, room, method);
      const auto* bytes = static_cast<const unsigned char*>(renderer.visibilityBytes.mapped);
      const auto lit = std::count(bytes, bytes + kSide * kSide, 255);
      std::printf("%-24s %8td %8td %8.2f %8.2f %8.2f %7d %5d %6d %7d %5ld\n", method.name, lit,
                  static_cast<std::ptrdiff_t>(kSide * kSide) - lit, cost.mapMs, cost.lookUpMs, cost.recordMs,
                  cost.calls.submits, cost.calls.waits, cost.calls.allocations, cost.calls.objects, cost.calls.heap);
      writeBytes(folder / (std::string(method.name) + ".visibility"), bytes, kSide * kSide);
      if (method.kind == Kind::Volume)
        writeBytes(folder / (std::string(method.name) + ".scattered"), renderer.fogBytes.mapped, 8 * kSide * kSide);
      device->releaseStaging();
      writePicture(folder / (std::string(method.name) + ".png"), renderer.pictureBytes.mapped);
      if (cost.calls.submits + cost.calls.waits + cost.calls.allocations + cost.calls.objects != 0)
        throw std::runtime_error("a steady frame makes or waits for something");
    }
  }
  destroy(gpu);
  return gpu.complaints == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bool validation = argc > 1 && std::string(argv[1]) == "--validation";
    if (argc != (validation ? 3 : 2)) throw std::runtime_error("usage: engine [--validation] FOLDER");
    return runAll(validation, argv[argc - 1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
