#pragma once
// Warps: planar maps whose texels are shaped to the camera. Real-Time Rendering, 3rd edition, section 9.1.4.
//
// Every warp is a matrix on the plane of light rays (planar/window.h), and nothing else. A projective map of
// space that sends each ray of the light to one texel sends the pencil of rays to the texels by a projective
// map of the plane, and its remaining row, depth, decides no texel. So PSM, whose light stands in the
// camera's post-perspective space, is such a matrix too, and the row of depth is ours to choose: it grows
// along every ray, in front of the camera and behind, which PSM's own does not; casters behind the camera
// come for free.
//
// "Light behind the camera" and "light within the view frustum", the papers' special cases, are left as one
// test, that W be positive on the whole slice and vary less than kMostWarp; a warp that fails is weakened, or
// refused with a note.

#include "planar/window.h"
#include "shadow/map_options.h"

#include "shared/scene.glsl"

#include <string>

namespace gnomon {

// Shapes a planar map's texels to the camera.
enum class Warp {
  None,
  Psm,     // perspective shadow maps: Stamminger and Drettakis 2002
  Lispsm,  // light space perspective shadow maps: Wimmer, Scherzer, Purgathofer 2004
  Tsm,     // trapezoidal shadow maps: Martin and Tan 2004
};

extern const ChoiceOption<Warp> kWarp;

// W's terms round by some 4 ulps of their largest, 2^-22, which where W is least is 64 * 2^-22 = 1.5e-5 of
// it: an eighth of a texel in a map of 8192.
inline constexpr double kMostWarp = 64.0;

struct WarpInput {
  const AxisFrame& frame;
  const glsl::CameraView& camera;
  std::span<const glm::dvec2> points;      // what the map must cover, plane coordinates
  std::span<const glm::dvec3> receiversW;  // what the camera sees
  int side = 1024;                         // texels
};

struct WarpedPlane {
  glm::dmat3 clipFromPlane{1.0};  // points within the square, half a texel from its edges
  bool warped = false;            // false where the warp cannot be had; `note` says why
  std::string note;               // may be empty
};

// `warp` is not None.
WarpedPlane warpPlane(Warp warp, const WarpInput& input);

// Corners of the convex hull, in order. Andrew 1979.
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

}  // namespace gnomon
