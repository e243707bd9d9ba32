#include "vsv_fixture.h"

#include <algorithm>

namespace gnomon::test {

VolumeWorld buildVolume(const gpu::Device& device, const VolumeSetup& setup) {
  VolumeWorld w;
  w.scene = openScene(setup.scene);
  w.tracer = std::make_unique<Tracer>(w.scene);
  w.buffers = createSceneBuffers(device, w.scene);
  const auto positional =
      std::ranges::find_if(w.scene.lights, [](const Light& light) { return light.type != LightType::Directional; });
  w.light = {.type = LightType::Point, .positionW = setup.lightW ? *setup.lightW : glm::dvec3(positional->positionW)};
  w.view = cameraView(setup.camera ? *setup.camera : w.scene.cameras.front(), setup.pictureSide, setup.pictureSide);
  w.gbuffer = std::make_unique<GBuffer>(device, setup.pictureSide, setup.pictureSide);
  {
    gpu::Commands commands(device, "G-buffer");
    w.gbuffer->record(commands, w.buffers, w.view);
    commands.submitAndWait();
  }
  const std::vector<glsl::PrimitiveId> ids = downloadPrimitiveIds(device, *w.gbuffer, w.buffers);
  w.receivers = computeReceivers(*w.tracer, w.view, w.light, ids);
  std::vector<glm::dvec3> scored;
  for (size_t i = 0; i < w.receivers.states.size(); ++i)
    if (w.receivers.states[i] == PixelState::Scored) scored.push_back(w.receivers.samples[i].positionW);
  w.columns = volumeParameterization().fit(
      {.scene = w.scene,
       .light = w.light,
       .receiversW = scored,
       .side = setup.cubeSide,
       .camera = w.view,
       .options = {kVolumeSize(setup.size), kVolumeSource(setup.source), kVolumeFit(setup.fit)}});
  w.volume = std::make_unique<ShadowVolume>(device, FittedVolume{.grid = w.columns.map.epipolar, .columns = w.columns},
                                            w.columns.lookedUpIn);
  const MapRenderer maps(device);
  const VolumeRenderer renderer(device);
  gpu::Commands commands(device, "shadow volume");
  renderer.record(commands, maps, w.buffers, *w.volume, w.light, CullMode::None);
  commands.submitAndWait();
  return w;
}

VolumeScore scoreVolume(const gpu::Device& device, const VolumeWorld& w, const char* bias) {
  VisibilityPass pass(device, w.view.width, w.view.height);
  VolumeVisibility visibility(device);
  pass.setUniforms(shadeUniforms(w.view, w.light, defaultBiasParams(w.columns.map.sceneScale)));
  gpu::Commands commands(device, "visibility");
  visibility.record(commands, w.buffers, *w.gbuffer, *w.volume, pass, findBias(bias), true);
  commands.submitAndWait();
  VolumeScore score;
  score.diagnosis = gpu::downloadAs<glsl::PixelDiagnosis>(device, pass.diagnosis());
  score.visibility = gpu::downloadAs<float>(device, pass.visibility());
  const Truth truth = computeTruth(*w.tracer, w.light, w.receivers);
  std::vector<Verdict> verdicts(score.diagnosis.size(), Verdict::NotAsked);
  for (size_t i = 0; i < verdicts.size(); ++i) {
    const uint32_t flags = score.diagnosis[i].flags;
    // Edge-on within rounding: no light arrives either way.
    if ((flags & glsl::kPixelShaded) == 0)
      verdicts[i] = truth.lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    else
      verdicts[i] = (flags & glsl::kPixelCovered) == 0 ? Verdict::Uncovered
                    : (flags & glsl::kPixelLit) != 0   ? Verdict::Lit
                                                       : Verdict::Shadow;
  }
  const glm::dmat3 worldFromLight(glm::dvec3(w.columns.frame.rightW), glm::dvec3(w.columns.frame.upW),
                                  glm::dvec3(w.columns.frame.backW));
  score.labels = labelPixels(*w.tracer, w.light, w.receivers, truth, verdicts, [&](size_t pixel) {
    const glm::vec2 uv = glsl::mapTexelCenter(w.columns.map, glsl::unpackTexel(score.diagnosis[pixel].texel));
    const glsl::Ray ray = glsl::mapTexelRay(w.columns.map, 0, uv);
    return RayD{.origin = glm::dvec3(w.columns.frame.originW),
                .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
  });
  return score;
}

FittedMap columnsFor(double eyeDistance, const VolumeSize& size, VolumeFit fit, const Camera& camera) {
  Scene scene;
  scene.meshes.push_back({.positions = {{-50, -50, -50}, {50, 50, 50}, {50, -50, 50}}, .indices = {0, 1, 2}});
  scene.instances.push_back({});
  Camera placed = camera;
  placed.worldFromEye[3] = glm::vec4(0.0f, 0.0f, static_cast<float>(eyeDistance), 1.0f);
  const LightModel light{.type = LightType::Point};
  const glsl::CameraView view = cameraView(placed, 64, 48);
  return fitVolume({.scene = scene, .light = light, .receiversW = {}, .camera = view}, size, fit).columns;
}

}  // namespace gnomon::test
