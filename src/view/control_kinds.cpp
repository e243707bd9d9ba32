#include "view/control_kinds.h"

#include "base/error.h"
#include "base/parse.h"
#include "base/suggest.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

using Kind = Control::Kind;

bool toggleIn(const std::string& name, const std::string& text) {
  if (text == "on" || text == "true" || text == "1") return true;
  if (text == "off" || text == "false" || text == "0") return false;
  throw UsageError(fmt::format("{} {}: write on or off", name, text));
}

std::string onOff(bool value) {
  return value ? "on" : "off";
}

template <typename T>
T& at(const Place<T>& place, const ViewState& state) {
  return place(const_cast<ViewState&>(state));  // NOLINT: read only, by `get`
}

}  // namespace

double numberIn(const std::string& name, const std::string& text, double lower, double upper, const std::string& unit) {
  const std::optional<double> value = parseNumber(text);
  if (!value) throw UsageError(fmt::format("{} {}: is not a number", name, text));
  if (!(*value >= lower && *value <= upper))
    throw UsageError(fmt::format("{} {} is outside {:g}..{:g} {}", name, text, lower, upper, unit));
  return *value;
}

void checkChoice(const std::string& name, const std::string& text, const std::vector<std::string>& choices) {
  if (std::ranges::find(choices, text) == choices.end())
    throw UsageError(fmt::format("{} {}: no such choice; {}", name, text,
                                 chooseFrom(text, fmt::format("{}", fmt::join(choices, ", ")))));
}

void checkNoStream(const std::string& path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw UsageError(path + ": is no regular file; name one");
}

Control numberControl(Control control, const Place<double>& place) {
  control.kind = Kind::Number;
  control.get = [place](const ViewState& state) { return fmt::format("{}", at(place, state)); };
  control.set = [place, name = control.name, lower = control.lower, upper = control.upper, unit = control.unit](
                    ViewState& state, const std::string& text) {
    place(state) = numberIn(name, text, lower, upper, unit);
  };
  return control;
}

Control optionalControl(Control control, const Place<std::optional<double>>& place) {
  control.kind = Kind::Number;
  control.get = [place](const ViewState& state) {
    const std::optional<double>& value = at(place, state);
    return value ? fmt::format("{}", *value) : std::string();
  };
  control.set = [place, name = control.name, lower = control.lower, upper = control.upper, unit = control.unit](
                    ViewState& state, const std::string& text) {
    place(state) = text.empty() ? std::nullopt : std::optional(numberIn(name, text, lower, upper, unit));
  };
  return control;
}

Control toggleControl(Control control, const Place<bool>& place) {
  control.kind = Kind::Toggle;
  control.get = [place](const ViewState& state) { return onOff(at(place, state)); };
  control.set = [place, name = control.name](ViewState& state, const std::string& text) {
    place(state) = toggleIn(name, text);
  };
  return control;
}

Control textControl(Control control, const Place<std::string>& place) {
  control.get = [place](const ViewState& state) { return at(place, state); };
  control.set = [place](ViewState& state, const std::string& text) { place(state) = text; };
  return control;
}

}  // namespace gnomon
