#pragma once
// Resolves the command line's --light, --camera, --size and so on to a scene, a light, a camera and a picture size.

#include "base/parse.h"
#include "scene/gltf.h"
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
  std::string size = "1024";          // N or WxH, pixels
  GltfOptions gltf;                   // which files a scene may read
};

// The words of a command line that choose the same: the scene, and flags for what is not at its default.
std::vector<std::string> setupWords(const SetupOptions& options);

struct PictureSize {
  int width = 0;
  int height = 0;
};

// "640x480" or "512". Throws UsageError outside 1..16384.
PictureSize parseSize(const std::string& text);

// The light a map is made for. Throws UsageError (malformed) or WorldError (none of that name: lists those
// there are; or one that the map cannot take).
Light chooseLight(const SetupOptions& options, const Tracer& tracer, const Parameterization& map);

// The same; and for --light all every light of the scene that the map is made for (where there is none, those
// it can make do with). At least one.
std::vector<Light> chooseLights(const SetupOptions& options, const Tracer& tracer, const Parameterization& map);

// The lights that the command line asks for, whatever the map: the one it names, else the scene's.
std::vector<Light> lightsAsked(const SetupOptions& options, const Tracer& tracer);

// Throws UsageError (malformed) or WorldError (none of that name: lists those there are).
Camera chooseCamera(const SetupOptions& options, const Tracer& tracer);

}  // namespace gnomon
