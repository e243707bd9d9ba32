#include "lab/bench/bare_rays.h"

#include "base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

constexpr size_t kPacket = 16;
// Short of the surface by more than a float rounds: what a ray meets there is its own triangle.
constexpr float kEnd = 1.0f - 1e-4f;

void attach(RTCDevice device, RTCScene scene, const Mesh& mesh, const glm::mat4& worldFromMesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), mesh.positions.size()));
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), mesh.indices.size() / 3));
  if (positions == nullptr || indices == nullptr)
    throw WorldError("the scene's triangles do not fit into memory once more for limit/rtcOccluded16");
  for (const glm::vec3& position : mesh.positions) {
    const glm::vec3 posW(worldFromMesh * glm::vec4(position, 1.0f));
    std::memcpy(positions, &posW, sizeof posW);
    positions += 3;
  }
  std::memcpy(indices, mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void put(RTCRay16& rays, size_t lane, const LightRay& light) {
  rays.org_x[lane] = static_cast<float>(light.ray.origin.x);
  rays.org_y[lane] = static_cast<float>(light.ray.origin.y);
  rays.org_z[lane] = static_cast<float>(light.ray.origin.z);
  rays.dir_x[lane] = static_cast<float>(light.ray.dir.x);
  rays.dir_y[lane] = static_cast<float>(light.ray.dir.y);
  rays.dir_z[lane] = static_cast<float>(light.ray.dir.z);
  rays.tnear[lane] = 0.0f;
  rays.time[lane] = 0.0f;
  rays.mask[lane] = ~0u;
  rays.id[lane] = 0;
  rays.flags[lane] = 0;
}

}  // namespace

struct BareRays::Impl {
  struct Packet {
    RTCRay16 rays;
    alignas(64) float ends[kPacket];  // tfar before it is traced: all that Embree writes, and -infinity where blocked
    alignas(64) int valid[kPacket];
  };
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  size_t count = 0;
  std::vector<Packet> packets;

  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

BareRays::BareRays(const Scene& scene, const LightModel& light, const Receivers& receivers)
    : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  for (const Instance& instance : scene.instances)
    attach(impl_->device, impl_->scene, scene.meshes[static_cast<size_t>(instance.mesh)], instance.worldFromMesh);
  rtcCommitScene(impl_->scene);
  const LightRays rays(scene, light);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    const size_t lane = impl_->count++ % kPacket;
    if (lane == 0) impl_->packets.emplace_back();
    const LightRay ray = rays.towards(receivers.samples[i].positionW);
    put(impl_->packets.back().rays, lane, ray);
    impl_->packets.back().ends[lane] = static_cast<float>(ray.distance) * kEnd;
    impl_->packets.back().valid[lane] = -1;
  }
}

BareRays::~BareRays() = default;

double BareRays::trace() {
  const auto start = std::chrono::steady_clock::now();
  tbb::parallel_for(tbb::blocked_range<size_t>(0, impl_->packets.size(), 64), [&](const auto& range) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t i = range.begin(); i < range.end(); ++i) {
      Impl::Packet& packet = impl_->packets[i];
      std::ranges::copy(packet.ends, packet.rays.tfar);
      rtcOccluded16(packet.valid, impl_->scene, &context, &packet.rays);
    }
  });
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

size_t BareRays::occluded() const {
  size_t blocked = 0;
  for (const Impl::Packet& packet : impl_->packets)
    for (size_t lane = 0; lane < kPacket; ++lane)
      blocked += packet.valid[lane] != 0 && packet.rays.tfar[lane] < 0.0f ? 1 : 0;
  return blocked;
}

size_t BareRays::count() const {
  return impl_->count;
}

}  // namespace gnomon
