#pragma once
// Fitting in a plane perpendicular to the light's axis: what a planar map must cover, how its texels snap, and the
// depth range of its casters and receivers.
//
// A ray of the light is a point h of the projective plane: (x, y, 1) of the light's frame without
// perspective, (x, y, depth) with. A slice is a matrix on that plane, clipFromPlane: (X, Y, W) = M h covers
// the ray where |X|, |Y| <= W, and the rest of the slice's clipFromLight is its row of depth. A window is
// such a matrix, and so is every warp (planar/warp.h).

#include "scene/scene.h"

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

// A light's frame in double: columns right, up, back; the light looks along -z.
struct AxisFrame {
  glm::dvec3 originW{0.0};
  glm::dmat3 worldFromLight{1.0};
  bool perspective = false;  // plane coordinates are divided by depth

  // x, y: plane coordinates; z: depth, metres in front of the light.
  glm::dvec3 planeFromWorld(const glm::dvec3& posW) const;
  glm::dvec3 lightFromWorld(const glm::dvec3& posW) const;

  // What grows linearly along every ray of the projective frame, the depth that a matrix can store: the depth
  // itself, or -1/depth in perspective.
  double linearDepth(double depth) const { return perspective ? -1.0 / depth : depth; }
};

// The frame depends on the direction alone, so that it holds still when the camera moves.
AxisFrame axisFrame(const glm::dvec3& originW, const glm::dvec3& directionW, bool perspective);

struct Window {
  glm::dvec2 lower{0.0};  // plane coordinates
  glm::dvec2 upper{0.0};
};

// Bounds of plane coordinates.
Window windowOf(std::span<const glm::dvec2> points);

// The texel's size is rounded up to a step of a geometric series and the corner down to a multiple of that
// size: while the window moves by less than a texel and grows by less than a step, every texel keeps its
// place in the world.
inline constexpr double kTexelSizeStep = 1.0905077326652577;  // 2^(1/8): at most 9% of the resolution is lost
Window snapWindow(const Window& window, int side);
// Rounded up to a step of the same series.
double snapLength(double length);

// The window's edges to -1 and 1, the picture of a slice upright (y down in clip space).
glm::dmat3 clipFromPlane(const Window& window);

// The least and greatest W of all rays that a slice covers, for W scaled so that (X, Y, 1) are clip coordinates. The
// least is not positive where the slice holds rays that run across the light's plane or behind it.
struct WRange {
  double least = 0.0;
  double greatest = 0.0;
};
WRange wRange(const glm::dmat3& clipFromPlane);

// Depth of the nearest triangle within the slice, and not nearer than `least`; `farthest` where there is none.
double nearestCasterDepth(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane, double least,
                          double farthest);

// Depth of the farthest triangle within the slice; `nearest` where there is none behind it.
double farthestCasterDepth(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane, double nearest);

// How far the triangles within the slice, not nearer than `least`, reach from the depth `from` as a warped slice stores
// it: the greatest |linearDepth - linearDepth(from)| / W of those behind it (Behind) or before it.
enum class Reach { Before, Behind };
double casterReach(const Scene& scene, const AxisFrame& frame, const glm::dmat3& clipFromPlane, double least,
                   double from, Reach side);

}  // namespace gnomon
