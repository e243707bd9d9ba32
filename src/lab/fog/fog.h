#pragma once
// `gnomon fog`: light shafts by every chosen integrator, compared with a ray-traced reference. docs/media.md has the
// model and its units.

#include "lab/fog/fog_measure.h"
#include "lab/fog/fog_view.h"

#include <filesystem>
#include <functional>
#include <optional>

namespace gnomon {

// What changes through the frames: the lights or the camera move along a line, the lights go round the scene's centre,
// the density is another one each.
struct FogMotion {
  int frames = 0;
  bool camera = false;      // moves, else the lights
  glm::vec3 offsetW{0.0f};  // metres, from the first frame to the last
  double degrees = 0.0;     // of the lights about `axisW`, from the first frame to the last; 0: no orbit
  glm::vec3 axisW{0.0f};    // unit
  std::function<std::shared_ptr<const DensityGrid>(int frame)> densityAt;  // empty: one for all

  bool moves() const { return degrees != 0.0 || offsetW != glm::vec3(0.0f); }
};

struct FogOptions {
  std::vector<const Integrator*> integrators;
  std::vector<int> steps = {32, 128, 512};     // of those that take steps
  const Parameterization* marchMap = nullptr;  // cube or paraboloid
  MapOptions map;                              // size, source and fit of the volume
  int mapSide = 1024;                          // texels, of the march's map and of --vsv-source resample
  CullMode cull = CullMode::Solids;
  FogMedium medium;
  bool truth = false;
  bool cache = true;  // of the reference
  MediaReferenceOptions reference;
  int repeats = 5;  // of every timed stage; at least 1
  std::optional<FogMotion> motion;
  std::optional<float> exposure;  // of all pictures, per cd/m^2; absent: chosen for each run
  std::filesystem::path outDir;   // empty: no pictures
};

// The most frames of a motion; four digits name them.
inline constexpr int kMostFrames = 9999;

struct FogResult {
  FogView view;
  FogExposure exposure;        // of surfaces and medium together
  FogExposure mediumExposure;  // of the medium alone
  std::optional<MediaReference> reference;
  bool referenceFromCache = false;
  std::vector<MediaMethod> methods;
  std::vector<MediaRow> rows;          // one a method
  std::vector<ImageF> inScattered;     // one a row, rgb, cd/m^2
  std::vector<EqualTerms> equalTerms;  // of the volume's ways against the march
  std::optional<WorstPlace> worst;     // where the first row errs most
  Pictures pictures;                   // of the reference
  FileSums files;                      // of the folder, when all are written
  int framesDone = 0;                  // of --frames
  Pictures framePictures;              // some of them, "frame N of METHOD"
  std::string motionNote;              // of --frames: where the video is, or why there is none
  bool isComplete = true;              // false: it was interrupted
  double gbufferMs = 0.0;
};

// Throws WorldError and UsageError. Long work shows progress. Where it is interrupted (base/interrupt.h) what is done
// is there: pictures without a reference, or the frames by then.
FogResult runFog(const Session& session, const FogOptions& options);

}  // namespace gnomon
