#include "lab/core/session.h"

#include "base/error.h"
#include "scene/generate.h"

#include <fmt/format.h>

namespace gnomon {

Session::Session(const gpu::DeviceOptions& device, const SetupOptions& options)
    : Session(device, options, std::make_shared<const TracedScene>(openScene(options.scene, options.gltf)),
              parseSize(options.size)) {}

Session::Session(const gpu::DeviceOptions& device, const SetupOptions& options,
                 std::shared_ptr<const TracedScene> traced, const PictureSize& size)
    : SceneView(gpu::Device::create(device), traced, chooseCamera(options, traced->tracer), size.width, size.height),
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
