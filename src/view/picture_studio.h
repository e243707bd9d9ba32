#pragma once
// Draws pictures of states on one device, one after another, and keeps of each what the next can use: of a scene what
// is on the device, of a size its passes, of a light its map. Of the worker's thread alone.

#include "view/moving_detail.h"
#include "view/picture_worker.h"

#include "lab/fog/fog.h"
#include "vsv/media/media_pass.h"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

namespace gnomon {

class PictureStudio {
 public:
  explicit PictureStudio(const gpu::DeviceOptions& options);

  const gpu::Device& device() const { return *device_; }
  const Tracer& tracer() const { return traced_->tracer; }

  // The scene of a state, where it is not the last one's. Throws what is wrong with it, and keeps the last.
  void openScene(const ViewState& state);

  // At rest in full, else what the time budget allows; and learns what that is.
  std::shared_ptr<ViewPicture> draw(const PictureRequest& request);
  // Counts of a picture of fewer pixels: a large one is not labelled at once.
  void estimate(const PictureRequest& request, ViewPicture& picture);
  static bool needsEstimate(const PictureRequest& request, const ViewPicture& picture);
  // The rest of what is known of a picture at rest. False where `overtaken` said so: it is then not whole.
  bool refine(const PictureRequest& request, ViewPicture& picture, const std::function<bool()>& overtaken);
  // By ray tracing, for sides that show it; the picture is then replaced.
  static bool wantsReference(const ViewState& state);
  void traceReference(const PictureRequest& request, ViewPicture& picture);
  // Draws pictures that nobody sees: what is learnt from them and made for them, the first one that moves has.
  void rehearse(const PictureRequest& request, const std::function<bool()>& overtaken);

 private:
  // How much of a picture is drawn.
  struct Detail {
    double share = 1.0;        // of the picture's side
    int halvings = 0;          // of the maps' sides
    bool wholeScene = false;   // maps are fitted to all of the scene, so that they hold for any camera
    bool anew = false;         // all is drawn, whether it is known or not
    bool keepsOthers = false;  // what other sizes hold is still of use
  };
  struct LightAndKey {
    std::string key;
    std::shared_ptr<LightOnMap> lit;  // one of both sides, where they ask for the same map
    bool isLoose = false;             // fitted to more than this camera sees
    bool isStale = false;             // of another camera, or of a light that has moved on: only its room is of use
  };
  // What is kept of a size.
  struct Canvas {
    std::unique_ptr<ShadowPasses> passes;
    std::unique_ptr<MediaPass> media;
    std::unique_ptr<SceneView> view;
    std::string camera;
    std::array<LightAndKey, kSideCount> lights;
    std::optional<FogView> fog;
    std::string fogKey;
    std::set<std::string> methods;  // that its passes hold pipelines of
    uint64_t used = 0;

    void markStale();
  };
  // A side of a picture that is being drawn.
  struct Sheet {
    Canvas& canvas;
    const ViewState& state;
    size_t side = 0;
    const Detail& detail;
    ViewPicture& picture;

    const ViewSide& asked() const { return state.sides[side]; }
    SidePicture& drawn() const { return picture.sides[side]; }
    // Does a part of the work, and notes what it took.
    template <typename Work>
    void stage(const char* nameOfA, const char* nameOfB, const Work& work, bool isOfMap = false) const {
      const auto start = std::chrono::steady_clock::now();
      work();
      const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
      picture.stages.push_back({side == 0 ? nameOfA : nameOfB, ms.count(), isOfMap});
    }
  };

  std::shared_ptr<ViewPicture> draw(const PictureRequest& request, const Detail& detail);
  Detail detailFor(const PictureRequest& request) const;
  void learn(const PictureRequest& request, const ViewPicture& picture);
  Canvas& canvasFor(int width, int height);
  void forgetOldestSize();
  void forgetMethods(Canvas& drawn);
  std::string cameraOf(const ViewState& state) const;
  void lookFrom(Canvas& canvas, const ViewState& state, int width, int height, bool anew);
  LightOnMap& lightFor(const Sheet& sheet);
  void drawSide(const Sheet& sheet);
  const FogView& fogFor(const Sheet& sheet);
  void drawFog(const Sheet& sheet);

  std::shared_ptr<const gpu::Device> device_;
  std::shared_ptr<const TracedScene> traced_;
  std::unique_ptr<SceneView> root_;  // holds what is on the device of the scene
  std::string sceneKey_;
  std::map<std::pair<int, int>, Canvas> canvases_;  // by width and height, pixels
  std::shared_ptr<const DensityGrid> density_;
  std::string densityKey_;
  uint64_t uses_ = 0;
  MovingDetail moving_;
  bool madeAnything_ = false;  // that the last picture needed once
  std::string rehearsed_, restCamera_, restLight_;
};

}  // namespace gnomon
