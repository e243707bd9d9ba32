#include "scene/generate.h"

#include "base/error.h"
#include "base/suggest.h"
#include "scene/generate/scenes.h"
#include "scene/gltf.h"

#include <charconv>
#include <filesystem>

#include <fmt/format.h>

namespace gnomon {

namespace {

Scene makeDefaultCrowd() {
  return makeCrowd(kCrowdDefault);
}

// "crowd:N", or nothing where the name does not begin like that.
std::optional<Scene> openSizedCrowd(const std::string& name) {
  const std::string prefix = "crowd:";
  if (!name.starts_with(prefix)) return std::nullopt;
  uint64_t triangles = 0;
  const char* end = name.data() + name.size();
  const auto [stop, failure] = std::from_chars(name.data() + prefix.size(), end, triangles);
  if (failure != std::errc() || stop != end || triangles < kCrowdMin || triangles > kCrowdMax)
    throw fileError(name, "is not a possible size of crowd",
                    fmt::format("give crowd:N with N from {} to {} triangles", kCrowdMin, kCrowdMax));
  return makeCrowd(triangles);
}

}  // namespace

const std::vector<GeneratedScene>& generatedScenes() {
  static const std::vector<GeneratedScene> scenes = {
      {"lshape", "acne at silhouettes and leaks at a crease: Weiskopf & Ertl 2003, figure 5.", makeLshape},
      {"double-torus",
       "leaks of the midpoint bias on curved solids, unfiltered and filtered: Weiskopf & Ertl 2003, figure 6.",
       makeDoubleTorus},
      {"factory", "thin and thick casters side by side, at the size of a real scene: Weiskopf & Ertl 2003, figure 7.",
       makeFactory},
      {"atrium",
       "acne on steep columns and leaks under arches, lit from inside: a scene like that of Dou et al. "
       "2014.",
       makeAtrium},
      {"corner", "acne alone: nothing casts a shadow in a concave corner of three planes.", makeCorner},
      {"grate", "thin casters near the light, shadows that fan out, light shafts: Wyman 2011, Dou et al. 2014.",
       makeGrate},
      {"sheets", "casters without thickness or back faces: leaves, a curtain and an alpha-masked fence.", makeSheets},
      {"contact", "detached shadows (peter-panning) where boxes, spheres and cylinders touch the floor.", makeContact},
      {"tilted-planes", "acne as a function of the angle to the light: planes at 0 to 88.5 degrees.", makeTiltedPlanes},
      {"near-far", "a bias in metres cannot be right at one metre and at forty: Dou et al. 2014, figure 7.",
       makeNearFar},
      {"crowd", "vertex throughput: instances of shared meshes; crowd:N has about N triangles, up to 19 million.",
       makeDefaultCrowd},
  };
  return scenes;
}

const GeneratedScene* findGeneratedScene(const std::string& name) {
  for (const GeneratedScene& scene : generatedScenes())
    if (name == scene.name) return &scene;
  return nullptr;
}

Scene openScene(const std::string& nameOrPath, const GltfOptions& options) {
  if (const GeneratedScene* generated = findGeneratedScene(nameOrPath)) return generated->make();
  if (std::optional<Scene> crowd = openSizedCrowd(nameOrPath)) return std::move(*crowd);
  std::error_code ignored;
  if (std::filesystem::exists(nameOrPath, ignored)) return loadGltf(nameOrPath, options);
  std::string names;
  for (const GeneratedScene& scene : generatedScenes()) names += (names.empty() ? "" : ", ") + std::string(scene.name);
  throw fileError(nameOrPath, "is neither a file nor the name of a generated scene",
                  fmt::format("give a .gltf or .glb file, or a generated scene; {}", chooseFrom(nameOrPath, names)));
}

}  // namespace gnomon
