#pragma once
// `gnomon fog`: light shafts by every chosen integrator, compared with a ray-traced reference. docs/media.md has the
// model and its units.

#include "lab/fog/fog_measure.h"
#include "lab/fog/fog_view.h"

#include <filesystem>
#include <optional>

namespace gnomon {

// A straight path that the light or the camera takes through the frames.
struct FogMotion {
  int frames = 0;
  bool camera = false;      // else the lights
  glm::vec3 offsetW{0.0f};  // metres, from the first frame to the last
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
  std::filesystem::path outDir;  // empty: no pictures
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
  std::string motionNote;              // of --frames: where the video is, or why there is none
  double gbufferMs = 0.0;
};

// Throws WorldError and UsageError. Long work shows progress.
FogResult runFog(const Session& session, const FogOptions& options);

}  // namespace gnomon
