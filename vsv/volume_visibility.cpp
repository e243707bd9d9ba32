#include "vsv/volume_visibility.h"

#include "base/check.h"

#include "shared/volume.glsl"

namespace gnomon {

bool volumeAnswers(const BiasMethod& method) {
  return method.onVolumes;
}

void VolumeVisibility::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                              const ShadowVolume& volume, const VisibilityPass& pass, const BiasMethod& method,
                              bool diagnose) {
  GNOMON_CHECK(volumeAnswers(method));
  const gpu::ComputeProgram& program =
      programs_.get("vsv/shade_volume_visibility.comp.glsl", {{.id = 0, .value = method.id},
                                                              {.id = 1, .value = diagnose ? 1 : 0},
                                                              {.id = 4, .value = scene.instanced ? 1 : 0}});
  commands.dispatch(program, pass.groupCount(), {},
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
