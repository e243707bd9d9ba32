#pragma once
// A scene on a device, seen by a camera: where rendering, ray tracing and labelling of one picture start.

#include "scene/gbuffer.h"
#include "truth/receivers.h"
#include "truth/tracer.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

// A scene and what traces rays through it; stays where it is made.
struct TracedScene {
  explicit TracedScene(Scene s) : scene(std::move(s)), tracer(scene) {}
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;
  const Scene scene;
  const Tracer tracer;
};

class GroundTruths;

class SceneView {
 public:
  // Uploads the scene and draws the G-buffer. `width` and `height` in pixels.
  SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced, const Camera& camera,
            int width, int height);
  // By the scene's first camera. Throws WorldError where it has none.
  SceneView(std::shared_ptr<const gpu::Device> device, Scene scene, int width, int height);
  SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced, int width,
            int height);
  // The same scene on the same device, seen by another camera.
  SceneView(const SceneView& other, const Camera& camera);
  // And in another size, pixels.
  SceneView(const SceneView& other, const Camera& camera, int width, int height);
  SceneView(SceneView&&) noexcept;
  ~SceneView();

  const Scene& scene() const { return traced_->scene; }
  const Tracer& tracer() const { return traced_->tracer; }
  const gpu::Device& device() const { return *device_; }
  const SceneBuffers& buffers() const { return *buffers_; }
  const GBuffer& gbuffer() const { return *gbuffer_; }
  const Camera& camera() const { return camera_; }
  const glsl::CameraView& view() const { return view_; }
  std::span<const glsl::PrimitiveId> primitiveIds() const { return ids_; }
  float sceneScale() const;  // the scene's diagonal, metres

  // What the camera sees, in double: one for all lights. Computed when first asked for.
  const SurfaceSamples& surfaces() const;
  GroundTruths& groundTruths() const { return *groundTruths_; }  // ground_truth.h

  // Another camera in the same size, with what is on the device. Whatever was made for the view before, a LightOnMap,
  // is of it no longer.
  void lookFrom(const Camera& camera);

  // Wall clock of drawing the G-buffer once more, milliseconds.
  double timeGBuffer() const;

 private:
  SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced,
            std::shared_ptr<const SceneBuffers> buffers, const Camera& camera, int width, int height);

  void see();

  std::shared_ptr<const TracedScene> traced_;
  std::shared_ptr<const gpu::Device> device_;
  std::shared_ptr<const SceneBuffers> buffers_;
  Camera camera_;
  glsl::CameraView view_{};
  std::unique_ptr<GBuffer> gbuffer_;
  std::vector<glsl::PrimitiveId> ids_;
  mutable std::optional<SurfaceSamples> surfaces_;
  std::unique_ptr<GroundTruths> groundTruths_;
};

}  // namespace gnomon
