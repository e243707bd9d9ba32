#include "media_fixture.h"

#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace gnomon::test {

MediaSetup mediaSetup(const char* scene) {
  MediaSetup setup{.scene = openScene(scene)};
  setup.camera = setup.scene.cameras.front();
  setup.light = mediaLight(*std::ranges::find(setup.scene.lights, LightType::Point, &Light::type));
  const float sigma = 0.5f / computeBounds(setup.scene).diagonal();
  setup.medium = {.sigmaS = glm::vec3(sigma), .sigmaA = glm::vec3(0.0f), .g = 0.2f};
  return setup;
}

MediaSetup emptyMediaSetup(const glm::vec3& eyeW, const glm::vec3& targetW, const glm::dvec3& lightW) {
  MediaSetup setup;
  const glm::vec3 behind = eyeW + 100.0f * (eyeW - targetW);
  setup.scene.materials.emplace_back();
  setup.scene.meshes.push_back({.positions = {behind, behind + glm::vec3(1e-3f, 0, 0), behind + glm::vec3(0, 1e-3f, 0)},
                                .normals = std::vector<glm::vec3>(3, {0, 0, 1}),
                                .uvs = std::vector<glm::vec2>(3),
                                .indices = {0, 1, 2}});
  setup.scene.instances.push_back({});
  setup.camera = lookAt("camera", eyeW, targetW, 1.0f);
  setup.pictureSide = 40;  // each pixel is integrated on the CPU, too
  setup.light = {.positionW = lightW, .intensity = {3.0f, 5.0f, 7.0f}};
  setup.medium = {.sigmaS = {0.05f, 0.08f, 0.02f}, .sigmaA = {0.01f, 0.0f, 0.1f}, .g = 0.4f, .reach = 12.0f};
  return setup;
}

MediaWorld::MediaWorld(const gpu::Device& device, const MediaSetup& given)
    : setup(given),
      buffers(createSceneBuffers(device, setup.scene)),
      view(cameraView(setup.camera, setup.pictureSide, setup.pictureSide)),
      gbuffer(device, setup.pictureSide, setup.pictureSide),
      pass(device, setup.pictureSide, setup.pictureSide),
      device_(device) {
  const Tracer tracer(setup.scene);
  const LightModel light{.type = LightType::Point, .positionW = setup.light.positionW};
  {
    gpu::Commands commands(device, "G-buffer");
    gbuffer.record(commands, buffers, view);
    commands.submitAndWait();
  }
  receivers = computeReceivers(tracer, view, light, downloadPrimitiveIds(device, gbuffer, buffers));
  if (setup.medium.reach == 0.0f) setup.medium.reach = defaultReach(setup.scene, view.eyeW);
  endsW = mediaReceiversW(view, receivers, setup.medium.reach);
  const FitInput input{
      .scene = setup.scene, .light = light, .receiversW = endsW, .side = setup.mapSide, .camera = view, .options = {}};
  fittedCube_ = cubeParameterization().fit(input);
  FitInput paraboloidInput = input;
  paraboloidInput.side = static_cast<int>(setup.mapSide * std::sqrt(3.0));  // as many texels
  FittedMap columns = fitVolume(input, setup.size, setup.fit);
  if (setup.source == VolumeSource::Resample) columns.occluderSource = std::make_shared<const FittedMap>(fittedCube_);
  volume = std::make_unique<ShadowVolume>(device, columns);
  cube = std::make_unique<MapImage>(device, fittedCube_);
  fittedParaboloid_ = paraboloidParameterization().fit(paraboloidInput);
  paraboloid = std::make_unique<MapImage>(device, fittedParaboloid_);
  const MapRenderer maps(device);
  gpu::Commands commands(device, "volume and maps");
  volume->recordDrawing(commands, maps, buffers, light, CullMode::None);
  maps.record(commands, buffers, *cube, light, CullMode::None);
  maps.record(commands, buffers, *paraboloid, light, CullMode::None);
  commands.submitAndWait();
  if (!setup.density.empty()) {
    density = std::make_unique<DensityGrid>(setup.density, DensityPlacement{});
    densityBuffers = std::make_unique<DensityBuffers>(createDensityBuffers(device, *density));
  }
  pass.setMedium(view, setup.medium, densityBuffers.get());
}

void MediaWorld::removeShadows() {
  const SceneBuffers nothing =
      createSceneBuffers(device_, emptyMediaSetup(view.eyeW, view.eyeW + view.forwardW, {}).scene);
  const MapRenderer maps(device_);
  const LightModel light{.type = LightType::Point, .positionW = setup.light.positionW};
  cube = std::make_unique<MapImage>(device_, fittedCube_);
  paraboloid = std::make_unique<MapImage>(device_, fittedParaboloid_);
  gpu::Commands commands(device_, "no shadows");
  commands.fill(*volume->bits(), 0);
  maps.record(commands, nothing, *cube, light, CullMode::None);
  maps.record(commands, nothing, *paraboloid, light, CullMode::None);
  commands.submitAndWait();
}

std::vector<glm::vec3> MediaWorld::scattered(const MediaMethod& method, bool ofParaboloid) {
  const MapImage& map = ofParaboloid ? *paraboloid : *cube;
  const Occluders& occluders = method.readsDepths() ? static_cast<const Occluders&>(map) : *volume;
  gpu::Commands commands(device_, "media");
  pass.recordTable(commands, occluders, setup.light);
  commands.barrier("the running integral is written -> pixels read it");
  pass.record(commands, buffers, gbuffer, occluders, setup.light, method, false);
  commands.submitAndWait();
  return gpu::downloadAs<glm::vec3>(device_, pass.inScattered());
}

namespace {

// Of a smooth function, to `tolerance` of its whole: Simpson's rule, halved where halving changes it.
glm::dvec3 adaptiveSimpson(const std::function<glm::dvec3(double)>& f, double a, double b, double tolerance,
                           int leastDepth) {
  const std::function<glm::dvec3(double, double, glm::dvec3, glm::dvec3, glm::dvec3, double, int)> refine =
      [&](double lo, double hi, glm::dvec3 flo, glm::dvec3 fmid, glm::dvec3 fhi, double allowed, int depth) {
        const double mid = 0.5 * (lo + hi);
        const glm::dvec3 fq = f(0.5 * (lo + mid)), fr = f(0.5 * (mid + hi));
        const glm::dvec3 whole = (flo + 4.0 * fmid + fhi) * ((hi - lo) / 6.0);
        const glm::dvec3 left = (flo + 4.0 * fq + fmid) * ((mid - lo) / 6.0);
        const glm::dvec3 right = (fmid + 4.0 * fr + fhi) * ((hi - mid) / 6.0);
        const glm::dvec3 change = glm::abs(left + right - whole);
        if (depth >= 40 || (depth >= leastDepth && std::max({change.x, change.y, change.z}) < 15.0 * allowed))
          return left + right + (left + right - whole) / 15.0;
        return refine(lo, mid, flo, fq, fmid, 0.5 * allowed, depth + 1) +
               refine(mid, hi, fmid, fr, fhi, 0.5 * allowed, depth + 1);
      };
  return refine(a, b, f(a), f(0.5 * (a + b)), f(b), tolerance, 0);
}

// Where eye + s dir meets the light's double cone: (axis . p)^2 = cos^2 p . p, a quadratic in s, with p from the light.
std::vector<double> coneCrossings(const MediaLightSource& light, const glm::dvec3& eyeW, const glm::dvec3& dir) {
  const glm::dvec3 from = eyeW - light.positionW;
  const double cos2 = light.coneCos * light.coneCos;
  const double axisDir = glm::dot(light.coneAxisW, dir), axisFrom = glm::dot(light.coneAxisW, from);
  const double a = axisDir * axisDir - cos2, b = axisDir * axisFrom - cos2 * glm::dot(dir, from),
               c = axisFrom * axisFrom - cos2 * glm::dot(from, from);
  if (std::abs(a) < 1e-12) return std::abs(b) < 1e-12 ? std::vector<double>{} : std::vector<double>{-c / (2.0 * b)};
  if (b * b < a * c) return {};
  const double root = std::sqrt(b * b - a * c);
  return {(-b - root) / a, (-b + root) / a};
}

}  // namespace

glm::dvec3 unshadowedLight(const glsl::Medium& medium, const MediaLightSource& light, const glm::dvec3& eyeW,
                           const glm::dvec3& endW, double begin) {
  const double length = glm::length(endW - eyeW), g = medium.g;
  const glm::dvec3 dir = (endW - eyeW) / length;
  const glm::dvec3 sigmaT = glm::dvec3(medium.sigmaS) + glm::dvec3(medium.sigmaA);
  const auto ofPointLight = [&](double s) {
    const glm::dvec3 fromLight = eyeW + dir * s - light.positionW;
    const double r = glm::length(fromLight);
    const double x = 1.0 + g * g - 2.0 * g * glm::dot(fromLight / r, -dir);
    const double phase = (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(x, 1.5));
    return glm::dvec3(medium.sigmaS) * glm::exp(-sigmaT * (s + r)) * glm::dvec3(light.intensity) * phase / (r * r);
  };
  // Cut where the ray passes the light, so that the peak cannot fall between samples, and where it crosses the cone.
  const double peak = std::clamp(glm::dot(light.positionW - eyeW, dir), begin, length);
  std::vector<double> cuts = {begin, peak, length};
  if (light.coneCos > -1.0)
    for (const double s : coneCrossings(light, eyeW, dir)) cuts.push_back(std::clamp(s, begin, length));
  std::ranges::sort(cuts);
  const double scale = glm::length(ofPointLight(peak)) * glm::length(eyeW + dir * peak - light.positionW);
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const glm::dvec3 middle = eyeW + dir * (0.5 * (cuts[i] + cuts[i + 1])) - light.positionW;
    if (light.coneCos > -1.0 && glm::dot(middle, light.coneAxisW) < light.coneCos * glm::length(middle)) continue;
    sum += adaptiveSimpson(ofPointLight, cuts[i], cuts[i + 1], 1e-9 * scale, 6);
  }
  return sum;
}

double relativeRmse(const std::vector<glm::vec3>& measured, const std::vector<glm::vec3>& expected) {
  double squares = 0.0, sum = 0.0;
  for (size_t i = 0; i < expected.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      squares += std::pow(static_cast<double>(measured[i][c]) - expected[i][c], 2);
      sum += expected[i][c];
    }
  }
  const double count = 3.0 * static_cast<double>(expected.size());
  return std::sqrt(squares / count) / (sum / count);
}

}  // namespace gnomon::test
