#include "vsv/volume_renderer.h"

#include "shared/volume.glsl"

namespace gnomon {

namespace {

constexpr const char* kFindOccluders = "vsv/find_occluders.comp.glsl";
constexpr const char* kVoxelize = "vsv/voxelize.comp.glsl";

uint32_t groups(int count, int size) {
  return static_cast<uint32_t>((count + size - 1) / size);
}

}  // namespace

void VolumeRenderer::record(gpu::Commands& commands, const MapRenderer& maps, const SceneBuffers& scene,
                            ShadowVolume& volume, const LightModel& light, CullMode cull) const {
  commands.beginStage("volume source");
  maps.record(commands, scene, volume.source(), light, cull);
  commands.endStage();
  commands.barrier("the source's depth is written -> columns read it");

  const glsl::EpipolarGrid& grid = volume.fitted().grid;
  commands.beginStage("volume occluders");
  commands.dispatch(programs_.get(kFindOccluders, {{.id = 0, .value = volume.source().kind()}}),
                    {groups(grid.thetaCount, glsl::kColumnGroupSide), groups(grid.phiCount, glsl::kColumnGroupSide), 1},
                    {},
                    {{glsl::kBindMap, volume.uniforms()},
                     {glsl::kBindSourceMap, volume.source().uniforms()},
                     {glsl::kBindMapDepth, volume.source().depth()},
                     {glsl::kBindOccluders, volume.occluders()}});
  commands.endStage();
  commands.barrier("occluders are written -> bits are set behind them");

  commands.beginStage("volume bits");
  recordBits(commands, volume, Voxelization::Fused);
  commands.endStage();
  commands.barrier("bits are written -> visibility reads them");
}

void VolumeRenderer::recordBits(gpu::Commands& commands, const ShadowVolume& volume, Voxelization how) const {
  const glsl::EpipolarGrid& grid = volume.fitted().grid;
  const glm::uvec3 size(groups(grid.thetaCount, glsl::kVoxelGroupSize),
                        static_cast<uint32_t>(grid.phiCount / glsl::kPhiBits), 1);
  const std::vector<gpu::Binding> bindings = {{glsl::kBindMap, volume.uniforms()},
                                              {glsl::kBindOccluders, volume.occluders()},
                                              {glsl::kBindBits, volume.bits()}};
  if (how == Voxelization::Fused) {
    commands.dispatch(programs_.get(kVoxelize, {{.id = 0, .value = glsl::kVoxelizeFused}}), size, {}, bindings);
    return;
  }
  commands.fill(volume.bits(), 0);
  commands.barrier("the volume is cleared -> the first occluded voxels are set");
  commands.dispatch(programs_.get(kVoxelize, {{.id = 0, .value = glsl::kVoxelizeSeed}}), size, {}, bindings);
  commands.barrier("the first occluded voxels are set -> the scan ORs what lies before");
  commands.dispatch(programs_.get(kVoxelize, {{.id = 0, .value = glsl::kVoxelizeScan}}), size, {}, bindings);
}

}  // namespace gnomon
