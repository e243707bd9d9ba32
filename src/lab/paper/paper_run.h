#pragma once
// Shared by the papers' figures: opening scenes, running comparisons, panels and their numbers, frames timed in rounds.

#include "lab/paper/reproduce.h"
#include "shadow/filter.h"
#include "vsv/shadow_volume.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

class PaperRun {
 public:
  PaperRun(const gpu::DeviceOptions& device, const ReproduceOptions& options, int partCount);

  // A figure or a table. On a user's own scene, what cannot be run is left out and the reason told.
  void part(const std::string& name, const std::function<void()>& work);
  void leaveOut(const std::string& what, const std::string& why);
  // The user's own scene where there is one, else the one asked for; it stays until another one is opened.
  const Session& open(const std::string& scene, const std::string& light, const std::string& camera, int pixels);
  // Another camera of the scene that is open.
  const Session& openCamera(const std::string& camera);
  const Session& session() const { return *session_; }
  bool ownScene() const { return !options_.scene.empty(); }
  const ReproduceOptions& options() const { return options_; }
  const gpu::DeviceOptions& device() const { return device_; }
  const std::string& progressTitle() const { return title_; }
  int scaled(int side) const;  // pixels or texels; at least 16
  VolumeSize scaled(const VolumeSize& size) const;

  void number(const std::string& quantity, const std::string& place, double value);
  Figure& addFigure(Figure figure);
  void addTable(PaperTable table) { result_.tables.push_back(std::move(table)); }
  void addComparison(const std::string& name, const std::string& json) { result_.comparisons.emplace_back(name, json); }
  void judge(const std::vector<Claim>& claims);
  Reproduction& result() { return result_; }

 private:
  const Session& open(const SetupOptions& setup);

  const gpu::DeviceOptions device_;
  const ReproduceOptions options_;
  const int partCount_;
  int parts_ = 0;
  std::string title_;
  std::string opened_;
  std::unique_ptr<Session> session_;
  Reproduction result_;
};

// The panels of one figure. Numbers of a panel are named by figure and panel: "acne(5b)", "leak(7 near slope)".
class FigureRun {
 public:
  FigureRun(PaperRun& run, const std::string& id, const std::string& title);

  // Everything of one map, with pictures in a folder of its own below the figure's.
  Comparison compare(const std::string& name, const CompareOptions& options);
  // `picture`: of the row's, beside its labels.
  void panel(const std::string& name, const Row& row, const std::string& what, const std::string& says,
             const char* picture = "beauty");
  void exactPanel(const std::string& name, const Comparison& comparison, const std::string& what,
                  const std::string& says);
  // Everything that faces the light is lit.
  void unshadowedPanel(const std::string& name, const Parameterization& map, const std::string& what,
                       const std::string& says);
  void number(const std::string& quantity, const std::string& panel, double value) {
    run_.number(quantity, id_ + (panel.size() == 1 ? "" : " ") + panel, value);
  }
  Figure& figure() { return run_.result().figures[index_]; }

 private:
  std::string folder() const { return "figure" + id_; }

  PaperRun& run_;
  const std::string id_;
  size_t index_;
  std::string below_;  // the last comparison's folder, below outDir
};

// The row of a comparison, which must be there.
const Row& rowOf(const Comparison& comparison, const std::string& bias, const std::string& filter = "none",
                 bool tuned = false);

// A knob at a share of the scene's diagonal.
KnobValue knobOfScale(const Session& session, const char* bias, float share);

// A frame: G-buffer, map, visibility, shading.
struct FrameKind {
  std::string name;
  const BiasMethod* bias = nullptr;  // nullptr: no shadow
  const Filter* filter = nullptr;
  int mapSide = 0;  // texels
};
struct FrameCost {
  double mapMs = 0.0, visibilityMs = 0.0, shadeMs = 0.0, frameMs = 0.0;  // medians; shading: all but the map
  double ratio = 0.0;  // of the frame to the first kind's, median over the rounds
};
// All kinds once a round, so that a machine that slows down slows all of them.
std::vector<FrameCost> timeFrames(const Session& session, const Parameterization& map,
                                  const std::vector<FrameKind>& kinds, int repeats, const std::string& progressTitle);

std::vector<Claim> weiskopfClaims();
Reproduction reproduceWeiskopf2003(const gpu::DeviceOptions& device, const ReproduceOptions& options);
Reproduction reproduceDou2014(const gpu::DeviceOptions& device, const ReproduceOptions& options);

}  // namespace gnomon
