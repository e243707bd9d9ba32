#include "truth/tracer.h"

#include "truth/triangle.h"

#include "base/check.h"
#include "base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

namespace gnomon {

namespace {

// How far beyond the receiver a segment is traced, as a share of its length: whatever lies near the receiver must reach
// the filter, which decides in double. Embree's float distances are good to 1e-6 but for surfaces seen edge-on.
constexpr float kOvershoot = 1.0f / 1024.0f;
// What Embree meets before this share of a segment to a point in mid-air blocks it without a second look.
constexpr float kSurelyBefore = 1.0f - kOvershoot;

// An instance whose matrix squeezes the unit cube to less than this share of the product of its axes' lengths
// has no usable inverse in float; its triangles are traced in world space instead.
constexpr double kLeastVolume = 1e-4;

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using OwnedDevice = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using OwnedScene = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using OwnedGeometry = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

struct InstanceFrame {
  glm::dmat4 worldFromMesh{1.0};
  bool identity = true;
};

bool isInvertible(const glm::dmat4& worldFromMesh) {
  const glm::dmat3 axes(worldFromMesh);
  const double lengths = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return std::abs(glm::determinant(axes)) > kLeastVolume * lengths;
}

Primitive hitPrimitive(RTCHitN* hit, unsigned n, unsigned i) {
  const unsigned instance = RTCHitN_instID(hit, n, i, 0);
  return {instance == RTC_INVALID_GEOMETRY_ID ? RTCHitN_geomID(hit, n, i) : instance, RTCHitN_primID(hit, n, i)};
}

// Where a float hit (u, v) lies in double. An edge-on triangle has no meeting point: Embree's stands in.
TriangleMeeting meetHit(const RayD& ray, const Triangle& triangle, double u, double v) {
  TriangleMeeting meeting = triangle.meet(ray);
  if (!meeting.edgeOn) return meeting;
  meeting.weights = {1.0 - u - v, u, v};
  meeting.positionW = triangle.corners[0] * meeting.weights.x + triangle.corners[1] * u + triangle.corners[2] * v;
  meeting.distance = glm::dot(meeting.positionW - ray.origin, ray.dir);
  return meeting;
}

}  // namespace

struct Tracer::Impl {
  // What a filter needs to know; Embree hands back the pointer to its first member.
  struct Query {
    RTCIntersectContext rtc = {};
    const Impl* impl = nullptr;
    const RayD* ray = nullptr;  // firstHit
    // Shadow rays, by the ray's id: segments and their ends, or from lightW to surfaces.
    const ShadowSegment* segments = nullptr;
    const glm::dvec3* ends = nullptr;
    const SurfaceSample* const* surfaces = nullptr;
    double* heights = nullptr;
    double enough = 0.0;
    const double* distances = nullptr;  // to points in mid-air, whose rays start at lightW
    const glm::dvec3* pointsW = nullptr;
    glm::dvec3 lightW{0.0};

    const Primitive& own(unsigned id) const { return segments != nullptr ? segments[id].own : surfaces[id]->primitive; }
    const glm::dvec3& end(unsigned id) const { return segments != nullptr ? ends[id] : surfaces[id]->positionW; }
    const glm::dvec3& planeNormal(unsigned id) const {
      return segments != nullptr ? segments[id].planeNormal : surfaces[id]->normalW;
    }
    RayD rayTo(unsigned id) const {
      if (segments != nullptr) return segments[id].ray;
      return {lightW, glm::normalize(surfaces[id]->positionW - lightW)};
    }
  };

  const Scene& scene;
  OwnedDevice device;
  std::vector<InstanceFrame> frames;   // one an instance
  std::vector<const Mesh*> meshes;     // one an instance
  std::vector<OwnedScene> meshScenes;  // one a mesh, of shared meshes only
  OwnedScene top;
  Bounds boundsW;
  glm::dvec3 center{0.0};  // of the bounds
  double radius = 0.0;     // metres, a sphere around them

  explicit Impl(const Scene& s) : scene(s) {}
  void throwIfFailed() const;
  OwnedScene newScene() const;
  void attachMesh(RTCScene into, const Mesh& mesh, const InstanceFrame& frame, unsigned id) const;
  void attachInstance(RTCScene mesh, const glm::mat4& worldFromMesh, unsigned id) const;
  void corners(const Primitive& primitive, glm::dvec3 out[3]) const;
  bool isHole(const Primitive& primitive, const glm::dvec3& weights) const;
  glm::vec3 floatOrigin(const RayD& ray, double distance) const;
  glm::vec3 floatSpan(const RayD& ray, double distance, const glm::dvec3& end, glm::vec3& origin) const;
  void putRay(const RayD& ray, double distance, const glm::dvec3& end, RTCRay16& rays, unsigned id) const;
  void traceOne(const ShadowSegment& segment, double enough, double& height) const;
  void tracePacket(std::span<const ShadowSegment> segments, double enough, double* heights) const;
  void traceNear(const glm::dvec3& lightW, std::span<const SurfaceSample* const> receivers, double enough,
                 double* heights) const;
  void tracePoints(const glm::dvec3& lightW, std::span<const glm::dvec3> pointsW, uint8_t* blocked) const;
  static void passHoles(const RTCFilterFunctionNArguments* args);
  static void judgeBlocker(const RTCFilterFunctionNArguments* args);
  static void judgeBeforePoint(const Query& query, const RTCFilterFunctionNArguments* args);
};

// Passes first hits through holes. Set on masked meshes only.
void Tracer::Impl::passHoles(const RTCFilterFunctionNArguments* args) {
  const auto* query = reinterpret_cast<const Query*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const Primitive primitive = hitPrimitive(args->hit, args->N, i);
    glm::dvec3 at[3];
    query->impl->corners(primitive, at);
    const TriangleMeeting meeting =
        meetHit(*query->ray, Triangle(at), RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
    if (query->impl->isHole(primitive, meeting.weights)) args->valid[i] = 0;
  }
}

// Ends a shadow ray at the first blocker higher than enough, and keeps the highest of the others.
void Tracer::Impl::judgeBlocker(const RTCFilterFunctionNArguments* args) {
  const auto* query = reinterpret_cast<const Query*>(args->context);
  if (query->pointsW != nullptr) return judgeBeforePoint(*query, args);
  std::optional<Triangle> triangle;  // of a packet's rays most meet the same one
  Primitive last;
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    args->valid[i] = 0;
    const unsigned id = RTCRayN_id(args->ray, args->N, i);
    const Primitive primitive = hitPrimitive(args->hit, args->N, i);
    if (primitive == query->own(id)) continue;
    if (!triangle || !(primitive == last)) {
      glm::dvec3 at[3];
      query->impl->corners(primitive, at);
      triangle.emplace(at);
      last = primitive;
    }
    const TriangleMeeting meeting =
        meetHit(query->rayTo(id), *triangle, RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
    const double height = glm::dot(query->planeNormal(id), meeting.positionW - query->end(id));
    if (!(height > query->heights[id]) || query->impl->isHole(primitive, meeting.weights)) continue;
    query->heights[id] = height;
    if (height > query->enough) args->valid[i] = -1;
  }
}

// Passes hits at or behind the point, and holes.
void Tracer::Impl::judgeBeforePoint(const Query& query, const RTCFilterFunctionNArguments* args) {
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const Primitive primitive = hitPrimitive(args->hit, args->N, i);
    const Mesh& mesh = *query.impl->meshes[primitive.instance];
    const bool opaque = query.impl->scene.materials[static_cast<size_t>(mesh.material)].alphaMode != AlphaMode::Mask;
    if (opaque && RTCRayN_tfar(args->ray, args->N, i) < kSurelyBefore) continue;
    const unsigned id = RTCRayN_id(args->ray, args->N, i);
    const RayD ray{query.lightW, (query.pointsW[id] - query.lightW) / query.distances[id]};
    glm::dvec3 at[3];
    query.impl->corners(primitive, at);
    const TriangleMeeting meeting =
        meetHit(ray, Triangle(at), RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
    if (!(meeting.distance < query.distances[id]) || query.impl->isHole(primitive, meeting.weights)) args->valid[i] = 0;
  }
}

void Tracer::Impl::throwIfFailed() const {
  const RTCError error = rtcGetDeviceError(device.get());
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) {
    throw WorldError(fmt::format("{}: not enough memory to trace {} triangles; use a smaller scene", scene.name,
                                 triangleCount(scene)));
  }
  throw WorldError(fmt::format("{}: Embree failed with error {}; check the installation of libembree3", scene.name,
                               static_cast<int>(error)));
}

OwnedScene Tracer::Impl::newScene() const {
  OwnedScene made(rtcNewScene(device.get()));
  throwIfFailed();
  rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST);
  return made;
}

void Tracer::Impl::attachMesh(RTCScene into, const Mesh& mesh, const InstanceFrame& frame, unsigned id) const {
  if (mesh.indices.size() < 3) return;
  const uint32_t largest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
  GNOMON_CHECK_LT(static_cast<size_t>(largest), mesh.positions.size());
  const OwnedGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  throwIfFailed();
  void* positions = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(glm::vec3), mesh.positions.size());
  throwIfFailed();
  void* indices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), mesh.indices.size() / 3);
  throwIfFailed();
  auto* posW = static_cast<glm::vec3*>(positions);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    posW[i] = frame.identity ? p : glm::vec3(frame.worldFromMesh * glm::dvec4(p, 1.0));
  }
  std::memcpy(indices, mesh.indices.data(), mesh.indices.size() / 3 * 3 * sizeof(uint32_t));
  if (scene.materials[static_cast<size_t>(mesh.material)].alphaMode == AlphaMode::Mask) {
    rtcSetGeometryIntersectFilterFunction(geometry.get(), &passHoles);
  }
  rtcSetGeometryOccludedFilterFunction(geometry.get(), &judgeBlocker);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(into, geometry.get(), id);
  throwIfFailed();
}

void Tracer::Impl::attachInstance(RTCScene mesh, const glm::mat4& worldFromMesh, unsigned id) const {
  const OwnedGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  throwIfFailed();
  rtcSetGeometryInstancedScene(geometry.get(), mesh);
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &worldFromMesh[0][0]);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(top.get(), geometry.get(), id);
  throwIfFailed();
}

inline void Tracer::Impl::corners(const Primitive& primitive, glm::dvec3 out[3]) const {
  const Mesh& mesh = *meshes[primitive.instance];
  const InstanceFrame& frame = frames[primitive.instance];
  for (int k = 0; k < 3; ++k) {
    const size_t index = mesh.indices[3 * static_cast<size_t>(primitive.triangle) + static_cast<size_t>(k)];
    const glm::dvec3 position(mesh.positions[index]);
    out[k] = frame.identity ? position : glm::dvec3(frame.worldFromMesh * glm::dvec4(position, 1.0));
  }
}

bool Tracer::Impl::isHole(const Primitive& primitive, const glm::dvec3& weights) const {
  const Mesh& mesh = *meshes[primitive.instance];
  const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
  if (material.alphaMode != AlphaMode::Mask) return false;
  const uint32_t* index = &mesh.indices[3 * static_cast<size_t>(primitive.triangle)];
  glm::vec2 uv(0.0f);
  for (int k = 0; k < 3; ++k) uv += mesh.uvs[index[k]] * static_cast<float>(weights[k]);
  return baseColorAt(scene, material, uv).w < material.alphaCutoff;
}

// A light far outside the scene would cost precision: floats along the ray are as coarse as the ray is long.
// Its rays start where they come near the scene instead.
inline glm::vec3 Tracer::Impl::floatOrigin(const RayD& ray, double distance) const {
  const double toCenter = glm::dot(center - ray.origin, ray.dir);
  const double skipped = toCenter - 2.0 * radius;
  return glm::vec3(skipped > 0.0 && skipped < distance ? ray.origin + ray.dir * skipped : ray.origin);
}

// The direction is the whole stretch from the rounded origin to the receiver, so that the rounding of the
// origin is made good at the end that matters, and distances are shares of the segment.
inline glm::vec3 Tracer::Impl::floatSpan(const RayD& ray, double distance, const glm::dvec3& end,
                                         glm::vec3& origin) const {
  GNOMON_CHECK_LT(0.0, distance);
  origin = floatOrigin(ray, distance);
  return glm::vec3(end - glm::dvec3(origin));
}

void Tracer::Impl::traceOne(const ShadowSegment& segment, double enough, double& height) const {
  const glm::dvec3 receiver = segment.ray.origin + segment.ray.dir * segment.distance;
  Query query{.impl = this, .segments = &segment, .ends = &receiver, .heights = &height, .enough = enough};
  rtcInitIntersectContext(&query.rtc);
  glm::vec3 origin;
  const glm::vec3 dir = floatSpan(segment.ray, segment.distance, receiver, origin);
  RTCRay ray = {.org_x = origin.x,
                .org_y = origin.y,
                .org_z = origin.z,
                .tnear = 0.0f,
                .dir_x = dir.x,
                .dir_y = dir.y,
                .dir_z = dir.z,
                .time = 0.0f,
                .tfar = 1.0f + kOvershoot,
                .mask = ~0u,
                .id = 0,
                .flags = 0};
  rtcOccluded1(top.get(), &query.rtc, &ray);
}

inline void Tracer::Impl::putRay(const RayD& ray, double distance, const glm::dvec3& end, RTCRay16& rays,
                                 unsigned id) const {
  glm::vec3 origin;
  const glm::vec3 dir = floatSpan(ray, distance, end, origin);
  rays.org_x[id] = origin.x;
  rays.org_y[id] = origin.y;
  rays.org_z[id] = origin.z;
  rays.dir_x[id] = dir.x;
  rays.dir_y[id] = dir.y;
  rays.dir_z[id] = dir.z;
  rays.tfar[id] = 1.0f + kOvershoot;
  rays.mask[id] = ~0u;
  rays.id[id] = id;
}

// Not flagged as coherent: with instances in the scene Embree 3.13.5's coherent packet path was seen not to return.
void Tracer::Impl::tracePacket(std::span<const ShadowSegment> segments, double enough, double* heights) const {
  glm::dvec3 ends[kPacket];
  Query query{.impl = this, .segments = segments.data(), .ends = ends, .heights = heights, .enough = enough};
  rtcInitIntersectContext(&query.rtc);
  alignas(64) int valid[kPacket] = {};
  RTCRay16 rays = {};
  for (unsigned i = 0; i < segments.size(); ++i) {
    ends[i] = segments[i].ray.origin + segments[i].ray.dir * segments[i].distance;
    valid[i] = -1;
    putRay(segments[i].ray, segments[i].distance, ends[i], rays, i);
  }
  rtcOccluded16(valid, top.get(), &query.rtc, &rays);
}

// From a light that is no farther than floatOrigin() lets rays start where they are: the rays have their origin in
// common, and of a lit one nothing else is worked out in double.
void Tracer::Impl::traceNear(const glm::dvec3& lightW, std::span<const SurfaceSample* const> receivers, double enough,
                             double* heights) const {
  Query query{.impl = this, .surfaces = receivers.data(), .heights = heights, .enough = enough, .lightW = lightW};
  rtcInitIntersectContext(&query.rtc);
  const glm::vec3 origin(lightW);
  alignas(64) int valid[kPacket] = {};
  RTCRay16 rays = {};
  for (unsigned i = 0; i < kPacket; ++i) {
    rays.org_x[i] = origin.x;
    rays.org_y[i] = origin.y;
    rays.org_z[i] = origin.z;
    rays.tfar[i] = 1.0f + kOvershoot;
    rays.mask[i] = ~0u;
    rays.id[i] = i;
  }
  for (unsigned i = 0; i < receivers.size(); ++i) {
    const glm::vec3 dir(receivers[i]->positionW - glm::dvec3(origin));
    rays.dir_x[i] = dir.x;
    rays.dir_y[i] = dir.y;
    rays.dir_z[i] = dir.z;
    valid[i] = -1;
  }
  rtcOccluded16(valid, top.get(), &query.rtc, &rays);
}

void Tracer::Impl::tracePoints(const glm::dvec3& lightW, std::span<const glm::dvec3> pointsW, uint8_t* blocked) const {
  double distances[kPacket];
  Query query{.impl = this, .distances = distances, .pointsW = pointsW.data(), .lightW = lightW};
  rtcInitIntersectContext(&query.rtc);
  alignas(64) int valid[kPacket] = {};
  RTCRay16 rays = {};
  for (unsigned i = 0; i < pointsW.size(); ++i) {
    const glm::dvec3 towards = pointsW[i] - lightW;
    distances[i] = glm::length(towards);
    valid[i] = -1;
    putRay({lightW, towards / distances[i]}, distances[i], pointsW[i], rays, i);
  }
  rtcOccluded16(valid, top.get(), &query.rtc, &rays);
  // Embree marks an occluded ray by a tfar of -infinity.
  for (size_t i = 0; i < pointsW.size(); ++i) blocked[i] = rays.tfar[i] < 0.0f ? 1 : 0;
}

Tracer::Tracer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {
  Impl& impl = *impl_;
  impl.device.reset(rtcNewDevice(nullptr));
  if (!impl.device) throw WorldError("Embree: cannot create a device; check the installation of libembree3");
  impl.top = impl.newScene();
  impl.boundsW = computeBounds(scene);
  impl.center = glm::dvec3(impl.boundsW.center());
  impl.radius = 0.5 * static_cast<double>(impl.boundsW.diagonal());

  std::vector<uint32_t> uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) {
    GNOMON_CHECK_LT(static_cast<size_t>(instance.mesh), scene.meshes.size());
    ++uses[static_cast<size_t>(instance.mesh)];
  }
  impl.meshScenes.resize(scene.meshes.size());
  for (const Instance& instance : scene.instances) {
    const auto meshIndex = static_cast<size_t>(instance.mesh);
    const Mesh& mesh = scene.meshes[meshIndex];
    GNOMON_CHECK_LT(static_cast<size_t>(mesh.material), scene.materials.size());
    const auto id = static_cast<unsigned>(impl.frames.size());
    impl.meshes.push_back(&mesh);
    impl.frames.push_back({glm::dmat4(instance.worldFromMesh), instance.worldFromMesh == glm::mat4(1.0f)});
    if (!instance.casts) continue;
    if (uses[meshIndex] == 1 || !isInvertible(impl.frames.back().worldFromMesh)) {
      impl.attachMesh(impl.top.get(), mesh, impl.frames.back(), id);
      continue;
    }
    OwnedScene& shared = impl.meshScenes[meshIndex];
    if (!shared) {
      shared = impl.newScene();
      impl.attachMesh(shared.get(), mesh, {}, 0);
      rtcCommitScene(shared.get());
      impl.throwIfFailed();
    }
    impl.attachInstance(shared.get(), instance.worldFromMesh, id);
  }
  rtcCommitScene(impl.top.get());
  impl.throwIfFailed();
}

Tracer::~Tracer() = default;

const Scene& Tracer::scene() const {
  return impl_->scene;
}

const Bounds& Tracer::boundsW() const {
  return impl_->boundsW;
}

std::optional<SurfaceHit> Tracer::firstHit(const RayD& ray) const {
  Impl::Query query{.impl = impl_.get(), .ray = &ray};
  rtcInitIntersectContext(&query.rtc);
  const glm::vec3 origin = impl_->floatOrigin(ray, std::numeric_limits<double>::max());
  RTCRayHit found = {};
  found.ray = {.org_x = origin.x,
               .org_y = origin.y,
               .org_z = origin.z,
               .tnear = 0.0f,
               .dir_x = static_cast<float>(ray.dir.x),
               .dir_y = static_cast<float>(ray.dir.y),
               .dir_z = static_cast<float>(ray.dir.z),
               .time = 0.0f,
               .tfar = std::numeric_limits<float>::infinity(),
               .mask = ~0u,
               .id = 0,
               .flags = 0};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->top.get(), &query.rtc, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  SurfaceHit hit;
  hit.primitive = {found.hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? found.hit.geomID : found.hit.instID[0],
                   found.hit.primID};
  glm::dvec3 at[3];
  impl_->corners(hit.primitive, at);
  const Triangle triangle(at);
  hit.distance = meetHit(ray, triangle, found.hit.u, found.hit.v).distance;
  hit.normalW = triangle.normal();
  return hit;
}

bool Tracer::occluded(const RayD& ray, double distance, const Primitive& own, const glm::dvec3& planeNormal,
                      double margin) const {
  double height = -std::numeric_limits<double>::infinity();
  impl_->traceOne({ray, distance, own, planeNormal}, margin, height);
  return height > margin;
}

void Tracer::blockerHeights(std::span<const ShadowSegment> segments, double enough, std::span<double> heights) const {
  GNOMON_CHECK_EQ(segments.size(), heights.size());
  std::fill(heights.begin(), heights.end(), -std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < segments.size(); i += kPacket) {
    impl_->tracePacket(segments.subspan(i, std::min(kPacket, segments.size() - i)), enough, &heights[i]);
  }
}

void Tracer::blockerHeights(const glm::dvec3& lightW, std::span<const SurfaceSample* const> receivers, double enough,
                            std::span<double> heights) const {
  GNOMON_CHECK_EQ(receivers.size(), heights.size());
  GNOMON_CHECK_LE(receivers.size(), kPacket);
  if (glm::length(lightW - impl_->center) > 2.0 * impl_->radius) {
    std::array<ShadowSegment, kPacket> segments;
    for (size_t i = 0; i < receivers.size(); ++i) {
      const glm::dvec3 towards = receivers[i]->positionW - lightW;
      const double distance = glm::length(towards);
      segments[i] = {{lightW, towards / distance}, distance, receivers[i]->primitive, receivers[i]->normalW};
    }
    return blockerHeights(std::span(segments).first(receivers.size()), enough, heights);
  }
  std::ranges::fill(heights, -std::numeric_limits<double>::infinity());
  impl_->traceNear(lightW, receivers, enough, heights.data());
}

void Tracer::blockPoints(const glm::dvec3& lightW, std::span<const glm::dvec3> pointsW,
                         std::span<uint8_t> blocked) const {
  GNOMON_CHECK_EQ(pointsW.size(), blocked.size());
  for (size_t i = 0; i < pointsW.size(); i += kPacket)
    impl_->tracePoints(lightW, pointsW.subspan(i, std::min(kPacket, pointsW.size() - i)), &blocked[i]);
}

void Tracer::corners(const Primitive& primitive, glm::dvec3 out[3]) const {
  GNOMON_CHECK_LT(primitive.instance, impl_->meshes.size());
  GNOMON_CHECK_LT(primitive.triangle, impl_->meshes[primitive.instance]->indices.size() / 3);
  impl_->corners(primitive, out);
}

}  // namespace gnomon
