// All that is set, as a file.

#include "base/error.h"
#include "base/parse_json.h"
#include "view/view_controls.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

constexpr int kSessionVersion = 1;

}  // namespace

std::string sessionJson(const ViewState& state) {
  const std::vector<Control> controls = viewControls(nullptr, state);
  nlohmann::ordered_json json;
  json["gnomon_view"] = kSessionVersion;
  for (const Control& control : controls) {
    if (!control.derived && control.isGiven(state)) json[control.name] = control.get(state);
  }
  return json.dump(2) + "\n";
}

namespace {

// "a.knob.reach": of a bias's file.
bool isFileKnob(const std::string& name) {
  return name.find(".knob.") == 1;
}

// `isPast`: of this program a while ago.
ViewState stateOf(const std::string& path, const std::string& text, const ViewState& others, bool isPast) {
  nlohmann::ordered_json json;
  try {
    json = parseJson<nlohmann::ordered_json>(text, {.depth = 4, .members = 1000});
  } catch (const nlohmann::json::exception&) {
    throw WorldError(path + ": is no JSON; open a session that gnomon view saved");
  }
  if (!json.is_object() || !json.contains("gnomon_view"))
    throw WorldError(path + ": is no session of gnomon view (it has no member gnomon_view)");
  if (json["gnomon_view"] != kSessionVersion)
    throw WorldError(
        fmt::format("{}: is a session of another version of gnomon view; this one reads {}", path, kSessionVersion));
  ViewState state = others;
  std::vector<Control> controls = viewControls(nullptr);
  std::array<uint64_t, kSideCount> files{};  // that `controls` has the parameters of
  for (ViewSide& side : state.sides) side.options.knobs.clear();
  for (const auto& [name, value] : json.items()) {
    if (name == "gnomon_view") continue;
    if (!value.is_string()) throw WorldError(fmt::format("{}: {} is no text", path, name));
    // A map or a bias comes before what only means something with it, as the controls stand in order.
    if (isPast && isFileKnob(name) && std::ranges::find(controls, name, &Control::name) == controls.end()) continue;
    const Control& control = findControl(controls, name);
    if (control.derived)
      throw WorldError(fmt::format("{}: {} follows from another member, which stands for it", path, name));
    try {
      control.set(state, value.get<std::string>());
    } catch (const UsageError&) {
      if (!isPast || !isFileKnob(name)) throw;  // out of its bounds by now
    }
    if (const auto chosen = chosenBiasFiles(state); chosen != std::exchange(files, chosen))
      controls = viewControls(nullptr, state);
  }
  return state;
}

ViewState stateNaming(const std::string& path, const std::string& text, const ViewState& others, bool isPast) {
  try {
    return stateOf(path, text, others, isPast);
  } catch (const std::exception& error) {  // of what a member is set to, for example
    const std::string what = error.what();
    throw WorldError(what.starts_with(path) ? what : path + ": " + what);
  }
}

}  // namespace

ViewState readSession(const std::string& path, const std::string& text, const ViewState& others) {
  return stateNaming(path, text, others, false);
}

ViewState readPastState(const std::string& what, const std::string& text, const ViewState& others) {
  return stateNaming(what, text, others, true);
}

}  // namespace gnomon
