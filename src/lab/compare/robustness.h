#pragma once
// How well tuned parameters work where they were not tuned, since nobody tunes a bias every frame: the same scene and
// light, seen by another camera, and mapped at half the resolution.

#include "lab/compare/compare.h"
#include "lab/compare/tune.h"

namespace gnomon {

// The camera carried round the point that the picture's centre shows, by kOrbitDegrees about the vertical, as
// far as nothing stands in the way.
inline constexpr double kOrbitDegrees = 25.0;
Camera orbitedCamera(const SceneView& view);

// What was tuned, and not yet how good it is elsewhere.
Tuning tuningOf(const TunedMethod& tuned);

class Robustness {
 public:
  Robustness(const LightOnMap& tuned, const CompareOptions& options);
  ~Robustness();

  // The tuned value there, and the best one there. Where the other camera sees nothing that faces the light,
  // it is left out.
  Tuning judge(const TunedMethod& tuned);

 private:
  struct Place;
  Transfer judgeAt(Place& place, const TunedMethod& tuned);

  SceneView otherView_;
  std::unique_ptr<Place> otherCamera_, otherMapSize_;
};

}  // namespace gnomon
