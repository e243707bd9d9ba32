#pragma once
// Flags that choose scene, light, camera and picture, and the device that draws it.

#include "lab/core/session.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gnomon {

struct SceneFlags {
  SetupOptions setup;
  std::string device;
};
// All that choose a session: addSceneFileFlags, casters, light, camera, picture size, device; --quiet.
void addSceneFlags(CLI::App& verb, SceneFlags& flags);
// SCENE, which it returns, --scene-index, --solids, --allow-path: what is read of a file.
CLI::Option* addSceneFileFlags(CLI::App& verb, SetupOptions& setup);
// --exposure, for verbs that write pictures of light.
void addExposureFlag(CLI::App& verb, std::optional<float>& exposure);
std::vector<std::string> sceneNames();  // of those that are generated

// Throws UsageError for --light all, which this verb cannot do.
void refuseAllLights(const SceneFlags& flags, const char* verb);
// Applies --device: a session on the chosen scene.
Session openSession(const SceneFlags& flags);

}  // namespace gnomon
