// All that is set, as a file.

#include "base/error.h"
#include "base/parse_json.h"
#include "view/view_controls.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

constexpr int kSessionVersion = 1;

// A scene's, a bias's or a density's, and not the name of one that is built in.
bool isFile(const std::string& value) {
  for (const char* extension : {".gltf", ".glb", ".glsl", ".vdb"})
    if (value.ends_with(extension)) return true;
  return value.find(".vdb:") != std::string::npos;
}

}  // namespace

std::string sessionJson(const ViewState& state, const std::string& path) {
  const std::vector<Control> controls = viewControls(nullptr, state);
  const fs::path folder = fs::path(path).parent_path();
  nlohmann::ordered_json json;
  json["gnomon_view"] = kSessionVersion;
  for (const Control& control : controls) {
    if (control.derived || !control.isGiven(state)) continue;
    std::string value = control.get(state);
    if (!folder.empty() && isFile(value) && fs::path(value).is_relative())
      value = fs::proximate(value, folder).string();
    json[control.name] = value;
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
    auto wanted = value.get<std::string>();
    if (!isPast && isFile(wanted) && fs::path(wanted).is_relative())
      wanted = fs::proximate(fs::path(path).parent_path() / wanted).string();
    try {
      control.set(state, wanted);
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
