#include "seen_scene.h"

#include "scene/generate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon::test {

namespace {

std::vector<glsl::PrimitiveId> tracePrimitives(const Tracer& tracer, const glsl::CameraView& view) {
  std::vector<glsl::PrimitiveId> ids;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 direction(glsl::pixelDirection(view, x, y));
      const auto hit = tracer.firstHit({.origin = glm::dvec3(view.eyeW), .dir = glm::normalize(direction)});
      ids.push_back(hit ? glsl::PrimitiveId{hit->primitive.instance + 1, hit->primitive.triangle}
                        : glsl::PrimitiveId{0, 0});
    }
  }
  return ids;
}

void addBox(Scene& scene, const glm::vec3& lower, const glm::vec3& upper) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                                (i & 4) != 0 ? upper.z : lower.z);
  mesh.normals.assign(8, {0, 1, 0});
  mesh.uvs.assign(8, {0, 0});
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  mesh.closed = computeClosed(mesh);
  scene.meshes.push_back(mesh);
  scene.instances.push_back({.mesh = static_cast<int>(scene.meshes.size()) - 1});
}

}  // namespace

FittedMap SeenScene::fit(const Parameterization& map, const MapOptions& options, int side) const {
  return map.fit(
      {.scene = *scene, .light = light, .receiversW = scored, .side = side, .camera = view, .options = options});
}

SeenScene see(Scene scene, const Camera& camera, const LightModel& light, int pictureSide) {
  SeenScene seen;
  seen.name = scene.name;
  seen.scene = std::make_unique<Scene>(std::move(scene));
  seen.tracer = std::make_unique<Tracer>(*seen.scene);
  seen.view = cameraView(camera, pictureSide, pictureSide);
  seen.light = light;
  seen.receivers = computeReceivers(*seen.tracer, seen.view, light, tracePrimitives(*seen.tracer, seen.view));
  for (size_t i = 0; i < seen.receivers.states.size(); ++i)
    if (seen.receivers.states[i] == PixelState::Scored) seen.scored.push_back(seen.receivers.samples[i].positionW);
  return seen;
}

SeenScene see(const std::string& sceneName, const Parameterization& map, int pictureSide, size_t camera) {
  Scene scene = openScene(sceneName);
  const Light light = *std::ranges::find_if(
      scene.lights, [&](const Light& l) { return map.supportsLight(l.type) == LightSupport::Yes; });
  const Camera chosen = scene.cameras.at(camera);
  const glm::dvec3 middle(glm::vec3(chosen.worldFromEye[3]) - glm::vec3(chosen.worldFromEye[2]) * 4.0f);
  const LightModel model = map.lightModel(light, glm::normalize(middle - glm::dvec3(light.positionW)));
  return see(std::move(scene), chosen, model, pictureSide);
}

Scene longFloor() {
  Scene scene;
  scene.name = "long floor";
  scene.materials.emplace_back();
  addBox(scene, {-60, -1, -60}, {60, 0, 60});
  for (int i = 0; i < 20; ++i) {
    const float z = 48.0f - 5.0f * static_cast<float>(i);
    addBox(scene, {-3.5f, 0, z}, {-3, 4, z + 0.5f});
    addBox(scene, {3, 0, z}, {3.5f, 4, z + 0.5f});
  }
  return scene;
}

Camera alongTheFloor() {
  return lookAt("along", {0.2f, 1.7f, 55.0f}, {0.2f, 1.2f, 45.0f}, 0.9f);
}

LightModel sun(double elevationDegrees, double azimuthDegrees) {
  const double elevation = glm::radians(elevationDegrees);
  const double azimuth = glm::radians(azimuthDegrees);
  // The camera looks along -z.
  return {.type = LightType::Directional,
          .directionW = {-std::cos(elevation) * std::sin(azimuth), -std::sin(elevation),
                         -std::cos(elevation) * std::cos(azimuth)}};
}

std::vector<MapOptions> allPlanarOptions() {
  std::vector<MapOptions> all;
  for (const WindowFit fit : {WindowFit::None, WindowFit::Tight, WindowFit::Focused}) {
    for (const Warp warp : {Warp::None, Warp::Psm, Warp::Lispsm, Warp::Tsm})
      all.push_back({kWindowFit(fit), kWarp(warp)});
    for (const int cascades : {2, 3, 4}) all.push_back({kWindowFit(fit), kCascades(cascades)});
    all.push_back({kWindowFit(fit), kSnap(false)});
    all.push_back({kWindowFit(fit), kSnap(false), kCascades(3)});
  }
  return all;
}

std::string describe(const MapOptions& options) {
  return fmt::format("fit {}, snap {}, warp {}, cascades {}", options.text(kWindowFit), options.text(kSnap),
                     options.text(kWarp), options.text(kCascades));
}

}  // namespace gnomon::test
