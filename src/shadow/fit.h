#pragma once
// Windows across a light's axis: what a planar map must cover, how its texels snap, how near its casters
// come.

#include "scene/scene.h"

#include <glm/glm.hpp>

namespace gnomon {

// A light's frame in double: columns right, up, back; the light looks along -z.
struct AxisFrame {
  glm::dvec3 originW{0.0};
  glm::dmat3 worldFromLight{1.0};
  bool perspective = false;  // plane coordinates are divided by depth

  // x, y: plane coordinates; z: depth, metres in front of the light.
  glm::dvec3 planeFromWorld(const glm::dvec3& posW) const;
};

// The frame depends on the direction alone, so that it holds still when the camera moves.
AxisFrame axisFrame(const glm::dvec3& originW, const glm::dvec3& directionW, bool perspective);

struct Window {
  glm::dvec2 lower{0.0};  // plane coordinates
  glm::dvec2 upper{0.0};
};

// The texel's size is rounded up to a step of a geometric series and the corner down to a multiple of that
// size: while the window moves by less than a texel and grows by less than a step, every texel keeps its
// place in the world.
inline constexpr double kTexelSizeStep = 1.0905077326652577;  // 2^(1/8): at most 9% of the resolution is lost
Window snapWindow(const Window& window, int side);

// Depth of the nearest triangle within the window, and not nearer than `least`; `farthest` where there is
// none.
double nearestCasterDepth(const Scene& scene, const AxisFrame& frame, const Window& window, double least,
                          double farthest);

}  // namespace gnomon
