#include "vsv/volume_visibility.h"

#include "base/check.h"

#include "shared/volume.glsl"

namespace gnomon {

bool volumeAnswers(const BiasMethod& method) {
  return method.id == glsl::kBiasNone || method.id == glsl::kBiasConstant || method.id == glsl::kBiasAdaptive;
}

const gpu::ComputeProgram& VolumeVisibility::program(const VariantKey& key) {
  for (const auto& variant : variants_)
    if (variant->key == key) return variant->program;
  variants_.push_back(std::make_unique<Variant>(Variant{key,
                                                        {device_,
                                                         {"vsv/shade_volume_visibility.comp.glsl", {}},
                                                         {{.id = 0, .value = key.method},
                                                          {.id = 1, .value = key.diagnose},
                                                          {.id = 4, .value = key.instanced}}}}));
  return variants_.back()->program;
}

void VolumeVisibility::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                              const ShadowVolume& volume, const VisibilityPass& pass,
                              const BiasMethod& method, bool diagnose) {
  GNOMON_CHECK(volumeAnswers(method));
  commands.dispatch(program({method.id, diagnose ? 1 : 0, scene.instanced ? 1 : 0}), pass.groupCount(), {},
                    {{glsl::kBindPositions, scene.positions},
                     {glsl::kBindTriangles, scene.triangles},
                     {glsl::kBindInstances, scene.instances},
                     {glsl::kBindMap, volume.uniforms()},
                     {glsl::kBindBits, volume.bits()},
                     {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
                     {glsl::kBindShade, pass.uniforms()},
                     {glsl::kBindVisibility, pass.visibility()},
                     {glsl::kBindDiagnosis, pass.diagnosis()}});
}

}  // namespace gnomon
