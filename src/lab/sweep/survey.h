#pragma once
// A plan's scenes, opened: their contents' hashes, and the lights and cameras that each is measured with.

#include "judge/scene_view.h"
#include "lab/store/store.h"
#include "lab/sweep/axes.h"

namespace gnomon {

// A light or a camera of one scene.
template <typename Thing>
struct Chosen {
  std::string name;  // in results: "lantern", "random 1"
  std::string text;  // as --light or --camera take it; empty: a scene's without lights
  Thing thing;
};

struct SurveyedScene {
  size_t at = 0;     // among the axes' scenes
  std::string hash;  // of what is drawn and traced
  size_t triangles = 0;
  double diagonal = 0.0;  // metres
  std::vector<Chosen<Light>> lights;
  std::vector<Chosen<Camera>> cameras;
  std::shared_ptr<const TracedScene> traced;  // where it was kept
};

// What a camera sees by a light: what one process works on at a time.
struct SweepView {
  size_t scene = 0;  // among the surveyed
  size_t camera = 0, light = 0;
};

struct Survey {
  std::vector<SurveyedScene> scenes;
  std::vector<SweepView> views;  // scene by scene, camera by camera
};

// Opens every scene, but those that `store` (may be null) knows a survey of, by the same program; the others' surveys
// are kept there. Throws WorldError: of a scene, or of a light or camera that no scene has.
Survey surveyScenes(const Plan& plan, const Axes& axes, Store* store, const std::string& program);

// Again, or the one that was kept.
std::shared_ptr<const TracedScene> tracedScene(const Axes& axes, const SurveyedScene& scene);

// Whether the map is made for this light; of several lights that are not, whether it makes do with it.
bool meets(const Parameterization& map, const Light& light, const std::vector<Chosen<Light>>& all);

}  // namespace gnomon
