#include "judge/unseen_occluders.h"

#include "base/check.h"

#include "shared/surface_bias.glsl"

#include <algorithm>
#include <vector>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Surfaces along one ray, at most; the rest are not looked at.
constexpr int kMostBlockers = 256;

// The connected surface that a triangle is of: a mesh's surfaces are counted for all its instances together.
class Surfaces {
 public:
  explicit Surfaces(const SceneView& view)
      : buffers_(view.buffers()), facts_(gpu::downloadAs<glsl::TriangleFacts>(view.device(), buffers_.triangleFacts)) {}

  bool areOne(const Primitive& a, const Primitive& b) const {
    return sheet(a) == sheet(b) && (!buffers_.instanced || a.instance == b.instance);
  }

 private:
  uint32_t sheet(const Primitive& p) const {
    const size_t triangle = buffers_.firstTriangles[p.instance] + p.triangle;
    GNOMON_CHECK_LT(triangle, facts_.size());
    return facts_[triangle].sheet;
  }

  const SceneBuffers& buffers_;
  std::vector<glsl::TriangleFacts> facts_;
};

// What the receiver's ray meets before the receiver's plane, from the light on. Each hit is passed by the end margin,
// which is more than the floats of the next ray's origin are off by; what lies nearer behind another counts as that.
std::vector<Primitive> blockersOf(const Tracer& tracer, const LightRays& rays, const SurfaceSample& receiver,
                                  double margin) {
  std::vector<Primitive> blockers;
  RayD ray = rays.towards(receiver.positionW).ray;
  for (int i = 0; i < kMostBlockers; ++i) {
    const std::optional<SurfaceHit> hit = tracer.firstHit(ray);
    if (!hit) break;
    const glm::dvec3 positionW = ray.origin + ray.dir * hit->distance;
    if (glm::dot(receiver.normalW, positionW - receiver.positionW) <= margin) break;
    if (hit->primitive != receiver.primitive && (blockers.empty() || blockers.back() != hit->primitive))
      blockers.push_back(hit->primitive);
    ray.origin = positionW + ray.dir * margin;
  }
  return blockers;
}

// What the texels around a point name.
std::vector<Primitive> namedAround(const SceneBuffers& scene, const MapIds& map, const glm::vec3& posL) {
  const glsl::ShadowMap& shape = map.fitted.map;
  std::vector<Primitive> named;
  const glsl::MapPoint point = glsl::mapProject(shape, posL);
  if (!point.covered) return named;
  const glsl::WitnessQuestion question = glsl::witnessQuestion(shape, posL, point);
  for (int i = map.reach == 4 ? 4 : 0; i < (map.reach == 4 ? 20 : 4); ++i) {
    const glsl::MapTexel found = glsl::mapTexelAcross(shape, question.slice, glsl::wantedTexel(question, i), posL);
    if (!found.held) continue;
    const size_t texel =
        (static_cast<size_t>(found.slice) * static_cast<size_t>(shape.height) + static_cast<size_t>(found.texel.y)) *
            static_cast<size_t>(shape.width) +
        static_cast<size_t>(found.texel.x);
    const glsl::PrimitiveId id = primitiveOf(scene.ids, scene.firstTriangles, map.ids[texel]);
    if (id.instancePlusOne != 0) named.push_back({id.instancePlusOne - 1, id.triangle});
  }
  return named;
}

template <typename Same>
bool haveCommon(const std::vector<Primitive>& a, const std::vector<Primitive>& b, const Same& same) {
  return std::ranges::any_of(
      a, [&](const Primitive& p) { return std::ranges::any_of(b, [&](const Primitive& q) { return same(p, q); }); });
}

}  // namespace

void findUnseenOccluders(LabelImage& image, const SceneView& view, const LightModel& light, const Receivers& receivers,
                         const Truth& truth, const MapIds& map) {
  const Surfaces surfaces(view);
  const LightRays rays(view.tracer().boundsW(), light);
  image.unseen.emplace();
  image.unseen->of.assign(image.labels.size(), Unseen::Nothing);
  tbb::parallel_for(size_t{0}, image.labels.size(), [&](size_t pixel) {
    if (image.labels[pixel] != Label::Leak && image.labels[pixel] != Label::EdgeLight) return;
    const SurfaceSample& receiver = receivers.samples[pixel];
    const std::vector<Primitive> blockers = blockersOf(view.tracer(), rays, receiver, truth.margin);
    const glm::vec3 posL = glsl::lightFromWorld(map.fitted.frame, glm::vec3(receiver.positionW));
    const std::vector<Primitive> named = namedAround(view.buffers(), map, posL);
    if (haveCommon(blockers, named, std::equal_to<Primitive>())) return;
    const bool sees =
        haveCommon(blockers, named, [&](const Primitive& p, const Primitive& q) { return surfaces.areOne(p, q); });
    image.unseen->of[pixel] = sees ? Unseen::Triangle : Unseen::Surface;
  });
  for (const Unseen unseen : image.unseen->of) {
    image.unseen->occluders += unseen != Unseen::Nothing ? 1 : 0;
    image.unseen->surfaces += unseen == Unseen::Surface ? 1 : 0;
  }
}

}  // namespace gnomon
