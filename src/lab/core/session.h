#pragma once
// A scene with its light and camera on a device: what every verb of the program starts from, and one
// configuration of it rendered, traced and labelled.

#include "base/image.h"
#include "lab/core/setup.h"
#include "shadow/visibility_pass.h"
#include "truth/labels.h"
#include "vsv/volume_renderer.h"
#include "vsv/volume_visibility.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

class Session {
 public:
  // Opens the scene, chooses the camera, uploads, draws the G-buffer. Throws WorldError, UsageError.
  Session(const gpu::DeviceOptions& device, const SetupOptions& options);
  // The same scene on the same device, seen by another camera.
  Session(const Session& other, const Camera& camera);

  const Scene& scene() const { return *scene_; }
  const Tracer& tracer() const { return *tracer_; }
  const gpu::Device& device() const { return *device_; }
  const SceneBuffers& buffers() const { return *buffers_; }
  const GBuffer& gbuffer() const { return *gbuffer_; }
  const Camera& camera() const { return camera_; }
  const glsl::CameraView& view() const { return view_; }
  std::span<const glsl::PrimitiveId> primitiveIds() const { return ids_; }
  const SetupOptions& setup() const { return setup_; }

  // Wall clock of drawing the G-buffer once more.
  double timeGBuffer() const;

 private:
  void drawGBuffer(int width, int height);

  SetupOptions setup_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const Tracer> tracer_;
  std::shared_ptr<const gpu::Device> device_;
  std::shared_ptr<const SceneBuffers> buffers_;
  std::unique_ptr<GBuffer> gbuffer_;
  Camera camera_;
  glsl::CameraView view_{};
  std::vector<glsl::PrimitiveId> ids_;
};

// What is exact about a light as one parameterization takes it: shared by all rows of that map.
struct Exact {
  Light source;      // as the scene or the command line has it
  LightModel light;  // as the map takes it
  Receivers receivers;
  Truth truth;
};
// Throws WorldError where the camera sees nothing that faces the light.
Exact computeExact(const Session& session, const Parameterization& parameterization);
// The same for one light; nothing may be scored.
Exact computeExact(const Session& session, const Parameterization& parameterization, const Light& source);
// The same for a light that is taken already; nothing may be scored.
Exact traceExact(const Session& session, const Light& source, const LightModel& light);

// A map fitted to what the camera sees, and how long that took.
struct Fit {
  FittedMap fitted;
  double ms = 0.0;
};
Fit fitMap(const Session& session, const Parameterization& parameterization, const Exact& exact, int side,
           const MapOptions& options);

// What draws maps and volumes; one for all of a session.
struct Renderers {
  MapRenderer map;
  VolumeRenderer volume;
  explicit Renderers(const gpu::Device& device) : map(device), volume(device) {}
};

// A fitted map, drawn with what a bias needs of it. Exactly one of the two is there.
struct DrawnMap {
  FittedMap fitted;
  std::unique_ptr<MapImage> image;
  std::unique_ptr<ShadowVolume> volume;
};
DrawnMap drawMap(const Session& session, const Renderers& renderers, const FittedMap& fitted, const Exact& exact,
                 ChannelSet channels, CullMode cull);
// Wall clock of drawing it once more.
double redrawMap(const Session& session, const Renderers& renderers, const DrawnMap& map, const Exact& exact,
                 CullMode cull);

// The passes that turn a map into pixels; one set for all maps of a session.
struct Passes {
  Renderers renderers;
  VisibilityPass visibility;
  VolumeVisibility volumeVisibility;
  RadiancePass radiance;
  Passes(const gpu::Device& device, const glsl::CameraView& view)
      : renderers(device),
        visibility(device, view.width, view.height),
        volumeVisibility(device),
        radiance(device, view.width, view.height) {}
};

// A bias with its knobs set.
struct Method {
  const BiasMethod* bias = nullptr;
  glsl::BiasParams params{};
};

// One visibility pass without diagnosis; wall clock.
double timeVisibility(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact,
                      const Method& method, const ChosenFilter& filter);

// The same, and what it says: one value a pixel.
std::vector<float> filteredVisibility(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact,
                                      const Method& method, const ChosenFilter& filter);

// One bias on one map: what it says of every pixel, and why it is wrong where it is.
struct Judged {
  std::vector<float> visibility;  // one a pixel
  std::vector<Verdict> verdicts;
  LabelImage labels;
  // Scored pixels that the shader's floats take for facing away: edge-on to the light or the camera within
  // rounding, where no light arrives either way. They count as agreeing.
  std::vector<size_t> edgeOn;
  size_t grazing = 0;  // scored pixels whose texel ray does not meet their plane between near and far
};
Judged judge(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact, const Method& method);

// The verdicts alone, and the texel that decided each pixel.
std::vector<glsl::PixelDiagnosis> diagnose(const Session& session, Passes& passes, const DrawnMap& map,
                                           const Exact& exact, const Method& method);
Verdict verdictOf(const glsl::PixelDiagnosis& pixel);

// Linear rgb by a given visibility, exposed so that a typical lit surface is neither dark nor burnt.
ImageF renderRadiance(const Session& session, Passes& passes, const Exact& exact, std::span<const float> visibility);

// The shading pass alone, by what the passes hold; wall clock.
double timeRadiance(const Session& session, Passes& passes);

// The light ray through the centre of the texel that decided a pixel, in the world.
RayD texelRayW(const FittedMap& fitted, uint32_t texelWord);

}  // namespace gnomon
