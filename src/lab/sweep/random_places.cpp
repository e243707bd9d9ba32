#include "lab/sweep/random_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kMostTries = 100000;
constexpr double kFovDegrees = 60.0;
// Shares of the scene's diagonal.
constexpr double kRoom = 0.01;     // around an eye or a light
constexpr double kNearest = 0.05;  // from an eye to what it looks at

class Places {
 public:
  Places(const Tracer& tracer, uint64_t seed) : tracer_(tracer), random_(seed) {
    const Bounds& bounds = tracer.boundsW();
    lower_ = glm::dvec3(bounds.lower);
    extent_ = glm::dvec3(bounds.upper) - lower_;
    diagonal_ = glm::length(extent_);
  }

  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  // In the bounds and somewhat around and above them: a closed room's outside is dark, and found to be so.
  glm::dvec3 point() {
    const double x = unit(), y = unit(), z = unit();
    return lower_ + glm::dvec3(1.5 * x - 0.25, 1.25 * y, 1.5 * z - 0.25) * extent_ +
           glm::dvec3(0.0, 0.1 * diagonal_ * y, 0.0);
  }

  glm::dvec3 direction() {
    const double z = 2.0 * unit() - 1.0, phi = 2.0 * std::numbers::pi * unit();
    const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
    return {r * std::cos(phi), z, r * std::sin(phi)};
  }

  // Nothing near, and hardly a surface that shows its back: not within a solid.
  bool isInAir(const glm::dvec3& at, double leastFronts) const {
    constexpr int kRays = 64;
    int fronts = 0, backs = 0;
    for (int i = 0; i < kRays; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / kRays, phi = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double r = std::sqrt(1.0 - z * z);
      const glm::dvec3 dir(r * std::cos(phi), z, r * std::sin(phi));
      const std::optional<SurfaceHit> hit = tracer_.firstHit({.origin = at, .dir = dir});
      if (!hit) continue;
      if (hit->distance < kRoom * diagonal_) return false;
      ++(glm::dot(hit->normalW, dir) < 0.0 ? fronts : backs);
    }
    return backs <= kRays / 8 && fronts >= leastFronts * kRays;
  }

  bool isLit(const SurfaceHit& hit, const RayD& ray, const Light& light) const {
    const glm::dvec3 at = ray.origin + ray.dir * hit.distance;
    const bool sun = light.type == LightType::Directional;
    const glm::dvec3 toLight = sun ? -glm::dvec3(light.directionW) : glm::dvec3(light.positionW) - at;
    const double distance = sun ? 4.0 * diagonal_ : glm::length(toLight);
    if (!(distance > 0.0)) return false;
    const glm::dvec3 way = glm::normalize(toLight);
    if (light.type == LightType::Spot &&
        glm::dot(-way, glm::normalize(glm::dvec3(light.directionW))) < std::cos(light.outerConeRad))
      return false;
    const glm::dvec3 seenSide = glm::dot(hit.normalW, ray.dir) < 0.0 ? hit.normalW : -hit.normalW;
    if (glm::dot(seenSide, way) <= 0.0) return false;
    const std::optional<SurfaceHit> first = tracer_.firstHit({.origin = at + way * distance, .dir = -way});
    return !first || first->primitive == hit.primitive || first->distance > distance * (1.0 - 1e-6);
  }

  // Of what a square picture shows at least a third is surface, and a tenth of that is lit.
  bool seesLit(const Camera& camera, const Light& light) const {
    constexpr int kGrid = 16;
    const double half = std::tan(0.5 * static_cast<double>(camera.yFovRad));
    const glm::dmat4 worldFromEye(camera.worldFromEye);
    int seen = 0, lit = 0;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const glm::dvec4 eye(half * (2.0 * (i % kGrid + 0.5) / kGrid - 1.0),
                           half * (2.0 * (i / kGrid + 0.5) / kGrid - 1.0), -1.0, 0.0);
      const RayD ray{.origin = glm::dvec3(worldFromEye[3]), .dir = glm::normalize(glm::dvec3(worldFromEye * eye))};
      const std::optional<SurfaceHit> hit = tracer_.firstHit(ray);
      if (!hit) continue;
      ++seen;
      lit += isLit(*hit, ray, light) ? 1 : 0;
    }
    return 3 * seen >= kGrid * kGrid && 10 * lit >= seen;
  }

  double diagonal() const { return diagonal_; }

 private:
  const Tracer& tracer_;
  std::mt19937_64 random_;
  glm::dvec3 lower_, extent_;
  double diagonal_ = 0.0;
};

std::string placeText(const glm::dvec3& at, const Scene& scene) {
  const glm::dvec3 written = at + scene.originW;
  // Digits for a thousandth of a per mille of the diagonal, whatever the origin.
  return fmt::format("{:.9g},{:.9g},{:.9g}", written.x, written.y, written.z);
}

}  // namespace

std::vector<std::string> randomCameras(const SetupOptions& setup, const Tracer& tracer,
                                       const std::vector<Light>& lights, int count, uint64_t seed) {
  std::vector<std::string> cameras;
  if (lights.empty()) return cameras;
  Places places(tracer, seed);
  for (int tries = 0; tries < kMostTries && std::ssize(cameras) < count; ++tries) {
    const Light& light = lights[cameras.size() % lights.size()];
    const RayD ray{.origin = places.point(), .dir = places.direction()};
    if (std::abs(ray.dir.y) > 0.9) continue;
    const std::optional<SurfaceHit> hit = tracer.firstHit(ray);
    if (!hit || hit->distance < kNearest * places.diagonal() || !places.isLit(*hit, ray, light)) continue;
    if (!places.isInAir(ray.origin, 0.0)) continue;
    SetupOptions chosen = setup;
    chosen.camera = fmt::format("eye:{},target:{},fov:{:g}", placeText(ray.origin, tracer.scene()),
                                placeText(ray.origin + ray.dir * hit->distance, tracer.scene()), kFovDegrees);
    if (places.seesLit(chooseCamera(chosen, tracer), light)) cameras.push_back(chosen.camera);
  }
  return cameras;
}

std::vector<std::string> randomLights(const Tracer& tracer, int count, uint64_t seed) {
  std::vector<std::string> lights;
  Places places(tracer, seed);
  for (int tries = 0; tries < kMostTries && std::ssize(lights) < count; ++tries) {
    const glm::dvec3 at = places.point();
    if (places.isInAir(at, 0.25)) lights.push_back(placeText(at, tracer.scene()));
  }
  return lights;
}

}  // namespace gnomon
