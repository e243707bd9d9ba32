#pragma once
// Resolves the command line's --light, --camera, --size and so on to a scene, a light, a camera and a picture size.

#include "base/parse.h"
#include "scene/gltf.h"
#include "scene/scene_choice.h"
#include "shadow/parameterization.h"
#include "truth/tracer.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct SetupOptions {
  std::string scene;   // a glTF file or a generated scene's name
  std::string light;   // NAME, #N, NAME@x,y,z or x,y,z; empty: the first the map can take, else one above the centre
  std::string camera;  // NAME, #N or eye:x,y,z,target:x,y,z[,fov:deg]; empty: the first, else one that sees the scene
  std::string direction;  // x,y,z: the way the light shines; empty: the light's own, else where the camera looks
  std::optional<double> coneDegrees;  // full angle of a spot
  std::optional<double> intensity;    // candela or lux, in place of the light's own
  std::string size;                   // N or WxH, pixels; empty: kDefaultSide, in the camera's own aspect
  GltfOptions gltf;                   // which of a file's scenes, and which files it may read
  SceneChoice choice;                 // casters and solids
};

// The words of a command line that choose the same: the scene, and flags for what is not at its default.
std::vector<std::string> setupWords(const SetupOptions& options);

struct PictureSize {
  int width = 0;
  int height = 0;
};

inline constexpr int kDefaultSide = 1024;  // pixels, of the longer side

// "640x480" or "512"; empty: kDefaultSide on the longer side, and on the other what `aspect` (width over height; 0:
// any) makes of it. Throws UsageError, which names `flag`, outside 1..16384.
PictureSize parseSize(const std::string& text, double aspect = 0.0, std::string_view flag = "--size");

// The scene that they name, as they choose it. Throws WorldError and UsageError.
Scene openScene(const SetupOptions& options);

// The light a map is made for. Throws UsageError: malformed; none of that name, with those there are; one that the map
// cannot take.
Light chooseLight(const SetupOptions& options, const Tracer& tracer, const Parameterization& map);

// The same; and for --light all every light of the scene that the map is made for (where there is none, those
// it can make do with). At least one.
std::vector<Light> chooseLights(const SetupOptions& options, const Tracer& tracer, const Parameterization& map);

// The lights that the command line asks for, whatever the map: the one it names, else the scene's.
std::vector<Light> lightsAsked(const SetupOptions& options, const Tracer& tracer);

// The map that a session draws where none is named: the usual one of the first light that is asked for; a spot where it
// is said which way it shines, or how wide.
const Parameterization& usualMapOf(const SetupOptions& options, const Tracer& tracer, const MapOptions& mapOptions);

// Throws UsageError (malformed, or none of that name: lists those there are).
Camera chooseCamera(const SetupOptions& options, const Tracer& tracer);

}  // namespace gnomon
