#pragma once
// What a camera sees of a scene and what a light faces of that, traced without a GPU: what maps are fitted to.

#include "planar/planar_map.h"
#include "scene/gbuffer.h"
#include "truth/visibility.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon::test {

struct SeenScene {
  std::string name;
  std::unique_ptr<Scene> scene;  // does not move: the tracer holds on to it
  std::unique_ptr<Tracer> tracer;
  glsl::CameraView view{};
  LightModel light;
  Receivers receivers;
  std::vector<glm::dvec3> scored;

  FittedMap fit(const Parameterization& map, const MapOptions& options, int side = 256) const;
};

// By the camera of that number; the light is the first that the map takes, aimed at the middle of the view.
SeenScene see(const std::string& sceneName, const Parameterization& map, int pictureSide, size_t camera = 0);
SeenScene see(Scene scene, const Camera& camera, const LightModel& light, int pictureSide);

// A floor of 120 m with pillars along it, seen along it from a man's height.
Scene longFloor();
Camera alongTheFloor();
// A sun, by the elevation from which it shines, to the right of the camera's view or, at azimuth 0, along it.
LightModel sun(double elevationDegrees, double azimuthDegrees);

// Every fit, warp and number of cascades that go together.
std::vector<MapOptions> allPlanarOptions();
std::string describe(const MapOptions& options);

}  // namespace gnomon::test
