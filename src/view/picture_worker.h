#pragma once
// Draws what a state asks for on a thread and a Vulkan device of its own, so that a window never waits: the newest
// request is drawn, at a size that the time budget allows while something moves, in full when all rests, and then
// refined: labels and counts by the exact shadow, what the maps hold, the reference of fog.
//
// A picture at rest is the one that `gnomon render` or `gnomon fog` writes, to the byte.

#include "judge/light_on_map.h"
#include "lab/core/depth_images.h"
#include "view/view_state.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

namespace gnomon {

struct PictureRequest {
  ViewState state;
  uint64_t number = 0;        // of this state; grows
  bool moving = false;        // more will come at once
  int width = 0, height = 0;  // pixels, of the picture in full
};

struct ViewStage {
  const char* name;
  double ms = 0.0;       // wall clock
  bool isOfMap = false;  // fewer texels make it shorter, not fewer pixels
};

// Pixels of each label, of so many scored.
struct ViewCounts {
  std::array<size_t, kLabelCount> labels{};
  size_t scored = 0;
  double share = 1.0;  // of the picture's side at which they were counted
};

// One side of a picture, and what is known of its pixels.
struct SidePicture {
  Image8 image;           // as it is written to a file, a legend below it included
  double exposure = 0.0;  // per cd/m^2, of a picture of light; else 0
  const Parameterization* map = nullptr;
  const BiasMethod* bias = nullptr;
  glsl::BiasParams params{};
  std::optional<ViewCounts> counts;  // of a large picture at rest first from fewer pixels
  // Where refined; of a picture without fog.
  std::shared_ptr<const GroundTruth> exact;
  std::optional<LabelledResult> judged;
  std::vector<glsl::PixelDiagnosis> diagnosis;
  std::optional<FittedMap> fitted;
  std::optional<DepthImages> depths;    // metres; for the loupe and the unfolded map
  std::vector<glsl::PrimitiveId> held;  // one a pixel: the triangle that its texel names, where the map stores that
  Image8 unfolded;
};

// All sides at one moment. Never changes once it is published.
struct ViewPicture {
  uint64_t number = 0;                // of the request
  int width = 0, height = 0;          // pixels, as drawn
  int mapHalvings = 0;                // how often the maps' sides were halved
  int fullWidth = 0, fullHeight = 0;  // as asked for
  bool refined = false;               // nothing more is to come
  bool counted = false;               // `judged` is there, of these pixels
  std::shared_ptr<const TracedScene> traced;
  Light light;
  glsl::CameraView camera{};
  std::array<SidePicture, kSideCount> sides;  // the second is empty without a split
  std::vector<ViewStage> stages;
  std::string problem;       // a line: why there is no new picture; the images are then the last good ones
  std::string note;          // of the fit
  bool sceneFailed = false;  // the problem is the scene itself: the last one stays
};

class PictureWorker {
 public:
  // `device`: as --device has it. `onPicture` is called from the worker's thread whenever there is a new picture.
  PictureWorker(const gpu::DeviceOptions& device, std::function<void()> onPicture);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  // Drawn instead of whatever was asked for before.
  void ask(PictureRequest request);
  std::shared_ptr<const ViewPicture> newest() const;  // null: none yet
  bool isIdle() const;                                // nothing asked for is left to draw or refine
  bool isReady() const;                               // and nothing is prepared for what may be asked for next
  // Messages of the validation layers so far.
  size_t validationMessages() const;
  // Forgets the device and all on it, as after its loss: for tests.
  void loseDevice();

 private:
  void run();

  gpu::DeviceOptions device_;
  std::function<void()> onPicture_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PictureRequest> asked_;
  std::shared_ptr<const ViewPicture> newest_;
  bool busy_ = false, prepares_ = false, ends_ = false, loses_ = false;
  size_t validationMessages_ = 0;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace gnomon
