#pragma once
// All that a person sets in the window, as one value: what is drawn follows from it alone, and so do the command line
// that draws the same, the session file and undo. view_controls.h declares how it is set.

#include "lab/compare/compare.h"
#include "lab/fog/fog.h"

#include <array>
#include <string>
#include <vector>

namespace gnomon {

// One of the two pictures that can stand beside each other. Of its options there is one map, one bias and one filter.
struct ViewSide {
  CompareOptions options;
  bool mapByLight = false;          // the map is the usual one of the light's kind, which the worker finds
  std::string show = "beauty";      // one of picturesToShow(); with fog on, of fogPicturesToShow()
  std::string integrator = "runs";  // of fog: one of integrators(), or kReferenceIntegrator
  int steps = 64;                   // of an integrator that takes steps
};

inline constexpr const char* kReferenceIntegrator = "reference";
inline constexpr int kSideCount = 2;  // A and B

struct FogState {
  bool on = false;
  std::optional<double> sigmaS;  // 1/m; absent: the default of `gnomon fog`
  double sigmaA = 0.0;           // 1/m
  double g = 0.2;
  double ambient = 0.0;                 // cd/m^2
  std::string density;                  // FILE.vdb[:grid]; empty: homogeneous
  std::optional<glm::dvec3> densityAt;  // metres; absent: where the file places it
  double densityScale = 1.0;
  double densityTurn = 0.0;  // degrees about y
};

struct ViewState {
  SetupOptions setup;
  std::array<ViewSide, kSideCount> sides;
  bool split = false;
  double splitAt = 0.5;      // share of the picture's width that shows A
  bool unfolded = false;     // the map of side A below the picture
  bool secondLayer = false;  // what lies behind its depths, where the bias stores that
  bool loupe = false;
  double budgetMs = 50.0;  // of a picture while something moves
  FogState fog;
};

// What of a method means nothing on its map gives way to what does.
void settleOnMap(CompareOptions& options);

// The maps of sides that leave them to the light.
void chooseMapsByLight(ViewState& state, const Tracer& tracer);

// A state as the program starts with: a method by `bias`, the scene as `setup` names it.
ViewState initialState(const SetupOptions& setup, const CompareOptions& options);

// The command line that makes the picture of a side, `width` x `height` pixels, into `file`: `gnomon render` or `gnomon
// fog`.
std::string pictureCommand(const ViewState& state, int side, int width, int height, const std::string& file);
// `gnomon compare` of what the sides show.
std::string comparisonCommand(const ViewState& state, int width, int height);

// What `gnomon fog` is asked for by that command. `originW`: Scene::originW.
FogMedium fogMediumOf(const FogState& fog, const glm::dvec3& originW);

}  // namespace gnomon
