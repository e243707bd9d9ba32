#include "lab/core/session.h"

#include "base/error.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

// What can be found wrong before a scene is read.
const SetupOptions& checked(const SetupOptions& options) {
  parseSize(options.size);
  return options;
}

}  // namespace

Session::Session(const gpu::DeviceOptions& device, const SetupOptions& options)
    : Session(device, options, std::make_shared<const TracedScene>(openScene(checked(options)))) {}

Session::Session(const gpu::DeviceOptions& device, const SetupOptions& options,
                 std::shared_ptr<const TracedScene> traced)
    : Session(device, options, traced, chooseCamera(options, traced->tracer)) {}

Session::Session(const gpu::DeviceOptions& device, const SetupOptions& options,
                 std::shared_ptr<const TracedScene> traced, const Camera& camera)
    : SceneView(gpu::Device::create(device), traced, camera, parseSize(options.size, camera.aspect).width,
                parseSize(options.size, camera.aspect).height),
      setup_(options) {}

LightOnMap openLight(const Session& session, ShadowPasses& passes, const Parameterization& map, MapSetup setup) {
  const Light source = chooseLight(session.setup(), session.tracer(), map);
  LightOnMap lit(session, passes, map, source, std::move(setup));
  if (lit.receivers().scored == 0)
    throw WorldError(
        fmt::format("light '{}', camera '{}': the camera sees no surface that faces the light; move one of them "
                    "with --light or --camera",
                    source.name, session.camera().name));
  return lit;
}

}  // namespace gnomon
