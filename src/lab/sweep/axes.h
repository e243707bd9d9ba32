#pragma once
// A plan's axes as the program understands them, before any scene is opened.

#include "lab/compare/compare.h"
#include "lab/sweep/plan.h"
#include "vsv/media/integrator.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

struct SweepMethod {
  std::string label;  // "constant offset=0.02"
  const BiasMethod* bias = nullptr;
  KnobChoices knobs;
  bool tune = false;
  std::shared_ptr<const UserBias> user;
};

struct SweepMap {
  const Parameterization* map = nullptr;
  MapChoice choice;         // side or texels, options, culling
  std::string optionsText;  // "warp=lispsm"
};

struct SweepScene {
  PlanScene spec;
  std::string name;    // in results
  SetupOptions setup;  // scene, solids, casters, size
};

struct SweepMedium {
  PlanMedium spec;
  std::vector<MediaMethod> methods;
  std::string label;  // "sigma_s=0.08, sigma_a=0, g=0.2"
  const Parameterization* map = nullptr;
};

struct Axes {
  std::vector<SweepScene> scenes;
  std::vector<SweepMap> maps;  // each of one size
  std::vector<SweepMethod> methods;
  std::vector<const Filter*> filters;
  std::vector<SweepMedium> media;
};

// Throws WorldError that names the place in the plan. `extraScenes`: folders, of which all .gltf and .glb files are
// scenes, too; `extraBiases`: files.
Axes axesOf(const Plan& plan, const std::vector<std::string>& extraScenes = {},
            const std::vector<std::string>& extraBiases = {});

// Whether an exclusion leaves this out. An empty bias or filter stands for all: only what excludes every one counts.
struct CaseNames {
  std::string scene, light, camera, map, bias, filter;
  int mapSize = 0;
};
bool isExcluded(const Plan& plan, const CaseNames& names);

}  // namespace gnomon
