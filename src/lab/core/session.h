#pragma once
// What every verb starts from: a scene, its camera and a picture size, as chosen on the command line.

#include "judge/light_on_map.h"
#include "lab/core/setup.h"

namespace gnomon {

class Session : public SceneView {
 public:
  // Throws WorldError, UsageError.
  Session(const gpu::DeviceOptions& device, const SetupOptions& options);
  // The same scene on the same device, seen by another camera.
  Session(const Session& other, const Camera& camera) : SceneView(other, camera), setup_(other.setup_) {}

  const SetupOptions& setup() const { return setup_; }

 private:
  Session(const gpu::DeviceOptions& device, const SetupOptions& options, std::shared_ptr<const TracedScene> traced);
  Session(const gpu::DeviceOptions& device, const SetupOptions& options, std::shared_ptr<const TracedScene> traced,
          const Camera& camera);

  SetupOptions setup_;
};

// The light that the command line names, on this map. Throws WorldError where the camera sees nothing that faces it.
LightOnMap openLight(const Session& session, ShadowPasses& passes, const Parameterization& map, MapSetup setup);

}  // namespace gnomon
