#include "lab/core/default_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gnomon {

namespace {

// Whether looking down on the scene one sees nothing but its top.
bool isRoofed(const Tracer& tracer) {
  constexpr int kGrid = 7;
  const Bounds& bounds = tracer.boundsW();
  const glm::vec3 extent = bounds.upper - bounds.lower;
  int covered = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const double u = 0.2 + 0.6 * (i % kGrid) / (kGrid - 1);
    const double v = 0.2 + 0.6 * (i / kGrid) / (kGrid - 1);
    const glm::dvec3 origin(bounds.lower.x + u * extent.x, bounds.upper.y + 0.1 * bounds.diagonal(),
                            bounds.lower.z + v * extent.z);
    const std::optional<SurfaceHit> hit = tracer.firstHit({.origin = origin, .dir = {0, -1, 0}});
    if (hit && origin.y - hit->distance > bounds.upper.y - 0.25 * extent.y) ++covered;
  }
  return covered > 9 * kGrid * kGrid / 10;
}

// Whether a place is in a room's air: surfaces all around, that show it their fronts. Within a solid they show their
// backs; in the open some rays meet nothing.
bool isInRoom(const Tracer& tracer, const glm::dvec3& placeW) {
  constexpr int kRays = 64;
  int fronts = 0;
  for (int i = 0; i < kRays; ++i) {
    // Evenly over the sphere, along a spiral of golden angles.
    const double z = 1.0 - (2.0 * i + 1.0) / kRays, phi = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const glm::dvec3 dir(r * std::cos(phi), z, r * std::sin(phi));
    const std::optional<SurfaceHit> hit = tracer.firstHit({.origin = placeW, .dir = dir});
    if (hit && glm::dot(hit->normalW, dir) < 0.0) ++fronts;
  }
  return fronts > 3 * kRays / 4;
}

glm::vec3 middleOfRoom(const Bounds& bounds) {
  return bounds.center() + glm::vec3(0.07f, 0.0f, 0.05f) * bounds.diagonal();
}

bool isRoom(const Tracer& tracer) {
  return isRoofed(tracer) && isInRoom(tracer, glm::dvec3(middleOfRoom(tracer.boundsW())));
}

// Whether the camera sees a surface, on a grid of rays, that turns the side it sees to the light, with nothing between.
bool seesLit(const Tracer& tracer, const Camera& camera, const Light& light) {
  constexpr int kGrid = 16;
  const double half = std::tan(0.5 * camera.yFovRad);
  const glm::dmat4 worldFromEye(camera.worldFromEye);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const glm::dvec4 eye(half * (2.0 * (i % kGrid + 0.5) / kGrid - 1.0), half * (2.0 * (i / kGrid + 0.5) / kGrid - 1.0),
                         -1.0, 0.0);
    const RayD ray{.origin = glm::dvec3(worldFromEye[3]), .dir = glm::normalize(glm::dvec3(worldFromEye * eye))};
    const std::optional<SurfaceHit> hit = tracer.firstHit(ray);
    if (!hit || hit->distance < camera.zNear) continue;
    const glm::dvec3 point = ray.origin + ray.dir * hit->distance;
    const bool sun = light.type == LightType::Directional;
    const glm::dvec3 toLight = sun ? -glm::dvec3(light.directionW) : glm::dvec3(light.positionW) - point;
    const glm::dvec3 seenSide = glm::dot(hit->normalW, ray.dir) < 0.0 ? hit->normalW : -hit->normalW;
    if (glm::dot(seenSide, toLight) <= 0.0) continue;
    const double distance = sun ? 4.0 * tracer.boundsW().diagonal() : glm::length(toLight);
    const RayD shadow{.origin = point + glm::normalize(toLight) * distance, .dir = -glm::normalize(toLight)};
    const std::optional<SurfaceHit> first = tracer.firstHit(shadow);
    if (!first || first->primitive == hit->primitive) return true;
  }
  return false;
}

std::vector<Camera> camerasInRoom(const Bounds& bounds) {
  const glm::vec3 extent = bounds.upper - bounds.lower;
  std::vector<Camera> cameras;
  for (const glm::vec2 corner : {glm::vec2(0.4f, 0.4f), glm::vec2(-0.4f, 0.4f), glm::vec2(-0.4f, -0.4f)}) {
    const glm::vec3 away(corner.x, 0.15f, corner.y), towards(-0.25f * corner.x, -0.15f, -0.25f * corner.y);
    cameras.push_back(
        lookAt("from a corner", bounds.center() + extent * away, bounds.center() + extent * towards, 1.2f));
  }
  return cameras;
}

std::vector<Camera> camerasOutside(const Bounds& bounds) {
  constexpr float kFov = 0.7854f;  // 45 degrees
  const float distance = 0.5f * bounds.diagonal() / std::sin(0.5f * kFov);
  std::vector<Camera> cameras;
  for (const glm::vec3 from :
       {glm::vec3(0.55f, 0.5f, 0.8f), glm::vec3(-0.8f, 0.5f, 0.55f), glm::vec3(-0.55f, 0.5f, -0.8f),
        glm::vec3(0.8f, 0.5f, -0.55f), glm::vec3(0.1f, 1.0f, 0.2f), glm::vec3(0.55f, -0.5f, 0.8f)})
    cameras.push_back(
        lookAt("sees the scene", bounds.center() + glm::normalize(from) * distance, bounds.center(), kFov));
  return cameras;
}

}  // namespace

float defaultNearPlane(const Bounds& boundsW) {
  return 1e-4f * boundsW.diagonal();
}

Camera defaultCamera(const Tracer& tracer, const Light& light) {
  const Bounds& bounds = tracer.boundsW();
  std::vector<Camera> cameras = camerasOutside(bounds), inside = camerasInRoom(bounds);
  if (isRoom(tracer))
    cameras.insert(cameras.begin(), inside.begin(), inside.end());
  else
    cameras.insert(cameras.end(), inside.begin(), inside.end());
  for (Camera& camera : cameras) camera.zNear = defaultNearPlane(bounds);
  const auto good = std::ranges::find_if(cameras, [&](const Camera& camera) { return seesLit(tracer, camera, light); });
  return good == cameras.end() ? cameras.front() : *good;
}

// A little off the vertical through the centre, so that no symmetry of the scene hides an artefact.
Light defaultLight(const Tracer& tracer) {
  const Bounds& bounds = tracer.boundsW();
  Light light;
  light.name = "above the centre";
  light.positionW = middleOfRoom(bounds);
  light.positionW.y = isRoom(tracer) ? bounds.center().y + 0.3f * (bounds.upper.y - bounds.lower.y)
                                     : bounds.upper.y + 0.5f * bounds.diagonal();
  const float distance = light.positionW.y - bounds.lower.y;
  light.intensity = 10.0f * distance * distance;
  return light;
}

}  // namespace gnomon
