#pragma once
// Single scattering of a point light in a medium, on the GPU: light shafts from the bits of a shadow volume,
// or by marching through a shadow map. The model is in shaders/shared/medium.glsl.

#include "scene/receiver_picture.h"
#include "shadow/occluders.h"
#include "vsv/media/density_buffers.h"
#include "vsv/media/integrator.h"

#include "shared/media_pass.glsl"

#include <string>
#include <vector>

namespace gnomon {

struct MediaLightSource {
  glm::dvec3 positionW{0.0};
  glm::vec3 intensity{1.0f};       // candela, a colour channel each
  glm::dvec3 coneAxisW{0, -1, 0};  // unit, the way a spot light shines
  double coneCos = -1.0;           // of its half angle, >= 0; -1: it shines everywhere
};
// Point and spot lights. Throws WorldError where it is a directional one.
MediaLightSource mediaLight(const Light& light);

// Metres from the eye to the farthest corner of the scene's bounds: a reach that ends every view ray.
float defaultReach(const Scene& scene, const glm::vec3& eyeW);

class MediaPass {
 public:
  // Whether it has buffers for what it finds, or writes images alone and shades no surfaces.
  enum class Output { Buffers, Images };
  MediaPass(const gpu::Device& device, int width, int height, Output output = Output::Buffers);

  // Of the frames recorded from now on. `density`: what makes the medium heterogeneous; it outlives them.
  void setMedium(const glsl::CameraView& camera, const glsl::Medium& medium, const DensityBuffers* density = nullptr);

  // The same of a homogeneous medium for the commands that follow, and what a renderer's depth means.
  void recordMedium(gpu::Commands& commands, const glsl::CameraView& camera, const glsl::Medium& medium,
                    const glsl::ReceiverPicture& meaning);

  // The table that record() reads: once a frame and light, before it, and a barrier between. Homogeneous: the
  // running integral in the frame of the volume, nothing for a map. Heterogeneous: the density between the
  // light and what is about it. Stage "media table".
  void recordTable(gpu::Commands& commands, const Occluders& occluders, const MediaLightSource& light);

  // Light scattered towards the eye. `occluders`: a volume's or a map's, as the integrator reads bits or depths. In a
  // heterogeneous medium every integrator marches, through whichever they are. `add`: to what other lights scattered.
  // Stage "media integrate".
  // Several lights: recordTable, barrier, record, barrier, recordTable of the next.
  // `into`: a storage image in GENERAL, R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT, instead of inScattered().
  void record(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
              const Occluders& occluders, const MediaLightSource& light, const MediaMethod& method, bool add,
              const gpu::Image* into = nullptr);
  // Compiles what recordTable() and record() of a homogeneous medium will need.
  void prepare(const SceneBuffers& scene, ReceiverKind receivers, const Occluders& occluders, const MediaMethod& method,
               const gpu::Image* into);

  // The surfaces' own light, attenuated from the light and to the eye; in a heterogeneous medium after
  // record() of the same light, whose table and depths to the eye it reads. `shade` and `visibility`: a
  // VisibilityPass's of the same camera, with lightColor the intensity over pi. Stage "media surfaces".
  void recordSurfaces(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                      const MediaLightSource& light, const gpu::Buffer& shade, const gpu::Buffer& visibility, bool add);

  // Surfaces and scattered light: radiance(). After a barrier behind both.
  void recordSum(gpu::Commands& commands);

  // A vec3 a pixel each, cd/m^2, tightly packed.
  const gpu::Buffer& inScattered() const { return inScattered_; }
  const gpu::Buffer& surfaces() const { return surfaces_; }
  const gpu::Buffer& radiance() const { return radiance_; }

 private:
  const gpu::ComputeProgram& integratorProgram(const SceneBuffers& scene, ReceiverKind receivers,
                                               const Occluders& occluders, const MediaMethod& method,
                                               const gpu::Image* into) const;
  void recordDensity(gpu::Commands& commands, const Occluders& occluders, const MediaLightSource& light,
                     const glsl::MediaPush& push, const gpu::Specialization& instanced,
                     std::vector<gpu::Binding> bindings);

  const gpu::Device& device_;
  gpu::ComputePrograms programs_;  // compiled at first use
  glm::uvec3 groupCount_;
  const DensityBuffers* density_ = nullptr;
  gpu::Buffer uniforms_, receiverPicture_;
  gpu::Image running_;
  gpu::Buffer lightDepth_, eyeDepth_;  // made at the first density
  gpu::Buffer inScattered_, surfaces_, radiance_;
};

}  // namespace gnomon
