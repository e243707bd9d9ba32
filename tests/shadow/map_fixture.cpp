#include "map_fixture.h"

#include <algorithm>
#include <cmath>

namespace gnomon::test {

namespace {

// `aimW`: where a light without a direction shines.
LightModel lightFor(const Scene& scene, const Parameterization& map, const glm::dvec3& aimW) {
  const auto wanted = std::ranges::find_if(
      scene.lights, [&](const Light& light) { return map.supportsLight(light.type) == LightSupport::Yes; });
  const Light light = wanted != scene.lights.end() ? *wanted : scene.lights.front();
  const glm::dvec3 aim = glm::normalize(aimW - glm::dvec3(light.positionW));
  return map.lightModel(light, aim);
}

glm::dvec3 meanSurface(const Receivers& receivers) {
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] == PixelState::Empty) continue;
    sum += receivers.samples[i].positionW;
    count += 1.0;
  }
  return sum / std::max(count, 1.0);
}

FittedMap fitContact(const Parameterization& map) {
  const Scene scene = findGeneratedScene("contact")->make();
  std::vector<glm::dvec3> receivers;
  const Bounds bounds = computeBounds(scene);
  for (int i = 0; i < 8; ++i)
    receivers.emplace_back(glm::mix(bounds.lower, bounds.upper, glm::vec3(i & 1, (i >> 1) & 1, i >> 2) * 0.6f + 0.2f));
  const LightModel light = lightFor(scene, map, glm::dvec3(bounds.center()));
  const glsl::CameraView camera = cameraView(scene.cameras.front(), 256, 256);
  return map.fit({.scene = scene, .light = light, .receiversW = receivers, .side = 256, .camera = camera});
}

}  // namespace

FittedMap fittedSpot() {
  return fitContact(spotParameterization());
}

FittedMap fittedDirectional() {
  return fitContact(directionalParameterization());
}

std::vector<MapSample> samplesOf(const FittedMap& fitted, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<MapSample> samples(count);
  for (size_t i = 0; i < count; ++i) {
    MapSample& sample = samples[i];
    sample.slice = static_cast<int>(i % static_cast<size_t>(fitted.map.sliceCount));
    sample.uv = {unit(random), unit(random)};
    const glsl::Ray ray = glsl::mapTexelRay(fitted.map, sample.slice, sample.uv);
    // Even in distance, so that both ends of a hyperbolic depth are met.
    const float length = glsl::mapDistance(fitted.map, sample.slice, ray, 1.0f);
    const float t = (0.001f + 0.998f * unit(random)) * length;
    sample.posL = ray.origin + ray.dir * t;
    sample.depth = glsl::mapDepth(fitted.map, sample.slice, sample.posL);
  }
  return samples;
}

RayD rayThrough(const FittedMap& fitted, int slice, glm::dvec2 place) {
  const glsl::Ray ray = glsl::mapTexelRay(fitted.map, slice, glm::vec2(place / static_cast<double>(fitted.map.width)));
  const glm::dmat3 worldFromLight(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                  glm::dvec3(fitted.frame.backW));
  return {.origin = glm::dvec3(fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
          .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
}

glm::vec3 facingNormal(const glm::vec3& rayDir, float tanAngle, float azimuth) {
  const glm::vec3 hint = std::abs(rayDir.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(hint, rayDir));
  const glm::vec3 v = glm::cross(rayDir, u);
  return glm::normalize(-rayDir + tanAngle * (u * std::cos(azimuth) + v * std::sin(azimuth)));
}

Rendered render(const gpu::Device& device, const std::string& sceneName, const Parameterization& map, int pictureSide,
                int mapSide, CullMode cull, ChannelSet channels) {
  Rendered r;
  r.scene = openScene(sceneName);
  r.tracer = std::make_unique<Tracer>(r.scene);
  r.buffers = createSceneBuffers(device, r.scene);
  r.view = cameraView(r.scene.cameras.front(), pictureSide, pictureSide);
  r.gbuffer = std::make_unique<GBuffer>(device, pictureSide, pictureSide);
  {
    gpu::Commands commands(device, "G-buffer");
    r.gbuffer->record(commands, r.buffers, r.view);
    commands.submitAndWait();
  }
  const std::vector<glsl::PrimitiveId> ids = downloadPrimitiveIds(device, *r.gbuffer, r.buffers);
  r.light = lightFor(r.scene, map, meanSurface(computeReceivers(*r.tracer, r.view, {}, ids)));
  r.receivers = computeReceivers(*r.tracer, r.view, r.light, ids);
  std::vector<glm::dvec3> scored;
  for (size_t i = 0; i < r.receivers.states.size(); ++i)
    if (r.receivers.states[i] == PixelState::Scored) scored.push_back(r.receivers.samples[i].positionW);
  r.fitted = map.fit({.scene = r.scene, .light = r.light, .receiversW = scored, .side = mapSide, .camera = r.view});
  r.renderer = std::make_unique<MapRenderer>(device);
  r.image = draw(device, r, channels, cull);
  return r;
}

std::unique_ptr<MapImage> draw(const gpu::Device& device, const Rendered& r, ChannelSet channels, CullMode cull,
                               std::optional<SecondLayer> method) {
  auto image = std::make_unique<MapImage>(device, r.fitted, channels, method);
  gpu::Commands commands(device, "shadow map");
  r.renderer->record(commands, r.buffers, *image, r.light, cull);
  commands.submitAndWait();
  return image;
}

}  // namespace gnomon::test
