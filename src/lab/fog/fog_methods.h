#pragma once
// Runs and times the integrators on the GPU.

#include "lab/fog/fog_view.h"

#include <vector>

namespace gnomon {

struct FogMethodOptions {
  std::vector<MediaMethod> methods;
  const Parameterization* marchMap = nullptr;
  MapOptions map;
  int mapSide = 1024;
  CullMode cull = CullMode::Solids;
  int repeats = 0;  // of every timed stage; 0: nothing is timed
};

struct FogMethodResult {
  ImageF inScattered;  // rgb, cd/m^2, of all lights
  // Medians of wall clock, summed over lights; milliseconds.
  double mapMs = 0.0;    // the volume, or the march's map
  double tableMs = 0.0;  // the running integral
  double integrateMs = 0.0;
  double buildMs() const { return mapMs + tableMs; }
};

// One a method, in order. `pass`: of the view's size, kept by who draws picture after picture.
std::vector<FogMethodResult> runFogMethods(const SceneView& scene, ShadowPasses& passes, MediaPass& pass,
                                           const FogView& view, const FogMethodOptions& options);
// The same by a pass of its own.
std::vector<FogMethodResult> runFogMethods(const SceneView& scene, ShadowPasses& passes, const FogView& view,
                                           const FogMethodOptions& options);

}  // namespace gnomon
