#pragma once
// How well parameters work where they were not chosen, since nobody tunes a bias every frame: the same scene and light,
// seen by another camera, and mapped at half the resolution.

#include "lab/compare/compare.h"
#include "lab/compare/tune.h"

namespace gnomon {

// The camera carried round the point that the picture's centre shows, by kOrbitDegrees about the vertical, as
// far as nothing stands in the way.
inline constexpr double kOrbitDegrees = 25.0;
Camera orbitedCamera(const SceneView& view);

// What was tuned, and not yet how good it is elsewhere.
Tuning tuningOf(const TunedMethod& tuned);

// Scored pixels of one light, or of several together, that a method has wrong.
struct ErrorCount {
  size_t scored = 0, biasErrors = 0, wrong = 0;
  std::optional<double> squares;  // of the differences, through a filter

  ErrorCount& operator+=(const ErrorCount& other);
  void tell(ErrorElsewhere& there) const;
};

class Robustness {
 public:
  Robustness(const LightOnMap& here, const CompareOptions& options);
  ~Robustness();

  // The value that was tuned through this filter there, and the best one there. Where the other camera sees nothing
  // that faces the light, it is left out.
  Tuning judge(const TunedMethod& tuned, const ChosenFilter& filter);

  // A method as it is, there. The counts come on top of those of other lights.
  struct Counts {
    ErrorCount otherCamera, otherMapSize;
  };
  Elsewhere judge(const Method& method, const ChosenFilter& filter, Counts& counts);
  Elsewhere judge(const Method& method, const ChosenFilter& filter);

 private:
  struct Place;

  SceneView otherView_;
  std::unique_ptr<Place> otherCamera_, otherMapSize_;
};

// Sets Row::elsewhere of the best row that is not tuned, where there are several methods to choose from.
void measureRecommended(const Session& session, ShadowPasses& passes, const CompareOptions& options,
                        std::vector<Row>& rows);

}  // namespace gnomon
