#pragma once
// Flags that choose scene, light, camera and picture, and the device that draws it.

#include "lab/core/session.h"

#include <string>

namespace CLI {
class App;
}

namespace gnomon {

struct SceneFlags {
  SetupOptions setup;
  std::string device;
};
// SCENE, --light, --camera, --direction, --cone, --size, --device, --shader-dir, --quiet.
void addSceneFlags(CLI::App& verb, SceneFlags& flags);
// Applies --device: a session on the chosen scene.
Session openSession(const SceneFlags& flags);

}  // namespace gnomon
