#pragma once
// Spot and directional maps: a window in a plane perpendicular to the light's axis, as one projection matrix.
//
// Both are fitted the same way. In the light's frame a point has plane coordinates, (x, y)/-z for a spot and
// (x, y) for a directional light, and a depth -z. What is to be covered there (kWindowFit; by default
// the bounds of what the camera sees of the scored receivers: sample distribution, Lauritzen et al. 2011)
// gives a window, whose texels snap to a grid that is fixed in the world, or the square of a warp; a
// directional map may have several (cascades). The near end is tightened to the nearest caster within the
// slice, the far end to the farthest receiver, or caster where the map is to be whole.

#include "planar/warp.h"
#include "shadow/parameterization.h"

namespace gnomon {

// What the window of a planar map encloses.
enum class WindowFit {
  None,     // the whole scene (directional), the whole cone (spot)
  Tight,    // the camera's frustum cut to the scene
  Focused,  // the surfaces that the camera sees and the light faces
};

inline constexpr int kMostCascades = 4;

// Of both kinds; kWarp is in warp.h.
extern const ChoiceOption<WindowFit> kWindowFit;
extern const ChoiceOption<bool> kSnap;  // texels keep their places in the world while the camera moves
extern const NumberOption kCascades;    // directional maps: slices, finest first

const Parameterization& spotParameterization();
const Parameterization& directionalParameterization();

// Both.
const std::vector<const Parameterization*>& planarParameterizations();

}  // namespace gnomon
