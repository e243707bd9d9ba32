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

// What a renderer of its own fits a map to: it has no scene on the CPU, but bounds that hold every caster and receiver.
struct BoundsFit {
  Bounds boundsW;                            // metres
  int side = 1024;                           // texels
  const glsl::CameraView* camera = nullptr;  // covers what it sees of the bounds (cameraOf()); nullptr: all of them
  double zNear = 0.01;                       // of a spot, metres along its axis: nearer than every caster
  bool snap = true;                          // kSnap
};
// A spot map of what of the bounds lies in the light's cone, and a directional map whose near end is where the bounds
// begin in front of its window. Nothing else than what the light and the fit say is known of the scene: where triangles
// stand nearer or less far, spotParameterization().fit() leaves depth more of its digits.
FittedMap makeSpotMap(const LightModel& light, const BoundsFit& fit);
FittedMap makeDirectionalMap(const LightModel& light, const BoundsFit& fit);

}  // namespace gnomon
