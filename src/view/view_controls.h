#pragma once
// What can be set in the window, declared once: menus, sliders and their tooltips, `set` in scripts and session files
// derive from it. It is itself made from the lists of maps, their options, biases, filters, integrators, with their
// units, ranges and sentences, so that what is added to those appears here by itself.

#include "judge/scene_view.h"
#include "view/view_state.h"

#include <functional>
#include <string>
#include <vector>

namespace gnomon {

struct Control {
  enum class Kind { Choice, Number, Whole, Toggle, Text };

  std::string name;      // of scripts and session files: "a.bias", "light.x"
  std::string label;     // in its group
  std::string group;     // "Scene", "Light", "A", ...
  std::string sentence;  // the tooltip
  std::string unit = {};
  Kind kind = Kind::Text;
  std::vector<std::string> choices = {};      // of a choice
  double lower = 0.0, upper = 1.0;            // of a number: what may be typed
  double slideLower = 0.0, slideUpper = 1.0;  // what a slider reaches
  bool logarithmic = false;
  bool derived = false;  // follows from another control, which is the one that is saved
  std::function<std::string(const ViewState&)> get;
  std::function<void(ViewState&, const std::string&)> set;  // throws UsageError, and leaves the state as it was
  std::function<bool(const ViewState&)> applies = [](const ViewState&) { return true; };
  // False: at a default that follows from the scene, and is not saved.
  std::function<bool(const ViewState&)> isGiven = [](const ViewState&) { return true; };
};

// `traced`: the scene that is shown, whose lights and cameras are offered; null where there is none yet. `state`: whose
// bias files are offered, with the parameters of those that are chosen: "a.knob.NAME".
std::vector<Control> viewControls(const std::shared_ptr<const TracedScene>& traced, const ViewState& state = {});
// Two states of one number have the same bias files chosen.
std::array<uint64_t, kSideCount> chosenBiasFiles(const ViewState& state);

// Throws UsageError, with the nearest name.
const Control& findControl(const std::vector<Control>& controls, const std::string& name);

// The light of a side, as its map takes it, before it is traced. Throws UsageError.
Light lightOf(const ViewState& state, const TracedScene& traced);
// Moves the light there, metres relative to Scene::originW; a directional light is made to shine from there to the
// scene's centre.
void moveLight(ViewState& state, const TracedScene& traced, const glm::dvec3& positionW);
// A camera that looks from one place to another, in the same frame; fov in degrees.
void placeCamera(ViewState& state, const TracedScene& traced, const glm::dvec3& eyeW, const glm::dvec3& targetW,
                 double fovDegrees);

// All that is saved, as one JSON document; and such a document as a state. `others`: a state whose bias files may be
// kept. Throws WorldError that names `path` where the text is none, UsageError where a value is refused.
// `path`: where it goes, since files are named from its folder; empty: nowhere.
std::string sessionJson(const ViewState& state, const std::string& path = "");
ViewState readSession(const std::string& path, const std::string& text, const ViewState& others);
// Of sessionJson() a while ago: the parameters that a bias's file has lost since are left out. `what`: "undo".
ViewState readPastState(const std::string& what, const std::string& text, const ViewState& others);

}  // namespace gnomon
