#include "judge/scene_view.h"

#include "base/error.h"
#include "judge/ground_truth.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

const Camera& firstCamera(const Scene& scene) {
  if (scene.cameras.empty()) throw WorldError(fmt::format("scene '{}' has no camera", scene.name));
  return scene.cameras.front();
}

std::shared_ptr<const SceneBuffers> uploaded(const gpu::Device& device, const Scene& scene) {
  return std::make_shared<const SceneBuffers>(createSceneBuffers(device, scene));
}

}  // namespace

SceneView::SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced,
                     std::shared_ptr<const SceneBuffers> buffers, const Camera& camera, int width, int height)
    : traced_(std::move(traced)),
      device_(std::move(device)),
      buffers_(std::move(buffers)),
      camera_(camera),
      view_(cameraView(camera, width, height)),
      gbuffer_(std::make_unique<GBuffer>(*device_, width, height)) {
  see();
}

SceneView::SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced,
                     const Camera& camera, int width, int height)
    : SceneView(device, traced, uploaded(*device, traced->scene), camera, width, height) {}

SceneView::SceneView(std::shared_ptr<const gpu::Device> device, Scene scene, int width, int height)
    : SceneView(std::move(device), std::make_shared<const TracedScene>(std::move(scene)), width, height) {}

SceneView::SceneView(std::shared_ptr<const gpu::Device> device, std::shared_ptr<const TracedScene> traced, int width,
                     int height)
    : SceneView(std::move(device), traced, firstCamera(traced->scene), width, height) {}

SceneView::SceneView(const SceneView& other, const Camera& camera)
    : SceneView(other, camera, other.view_.width, other.view_.height) {}

SceneView::SceneView(const SceneView& other, const Camera& camera, int width, int height)
    : SceneView(other.device_, other.traced_, other.buffers_, camera, width, height) {}

SceneView::SceneView(SceneView&&) noexcept = default;
SceneView::~SceneView() = default;

void SceneView::see() {
  groundTruths_ = std::make_unique<GroundTruths>();
  surfaces_.reset();
  timeGBuffer();
  ids_ = downloadPrimitiveIds(*device_, *gbuffer_, *buffers_);
}

void SceneView::lookFrom(const Camera& camera) {
  camera_ = camera;
  view_ = cameraView(camera, view_.width, view_.height);
  see();
}

const SurfaceSamples& SceneView::surfaces() const {
  if (!surfaces_) surfaces_ = computeSurfaces(tracer(), view_, ids_);
  return *surfaces_;
}

float SceneView::sceneScale() const {
  return computeBounds(scene()).diagonal();
}

double SceneView::timeGBuffer() const {
  gpu::Commands commands(*device_, "G-buffer");
  gbuffer_->record(commands, *buffers_, view_);
  return commands.submitAndWait().wallMs;
}

}  // namespace gnomon
