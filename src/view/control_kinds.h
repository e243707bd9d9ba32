#pragma once
// How controls are made, for the files that declare them.

#include "view/view_controls.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// Where a member of the state is.
template <typename T>
using Place = std::function<T&(ViewState&)>;

Control numberControl(Control control, const Place<double>& place);
// Empty where it has no value.
Control optionalControl(Control control, const Place<std::optional<double>>& place);
Control toggleControl(Control control, const Place<bool>& place);
Control textControl(Control control, const Place<std::string>& place);

// Throw UsageError.
double numberIn(const std::string& name, const std::string& text, double lower, double upper, const std::string& unit);
void checkChoice(const std::string& name, const std::string& text, const std::vector<std::string>& choices);
void checkNoStream(const std::string& path);  // a pipe, which would be waited for, or a folder

// scene_controls.cpp
void addScene(std::vector<Control>& controls);
void addLight(std::vector<Control>& controls, const std::shared_ptr<const TracedScene>& traced);
void addCamera(std::vector<Control>& controls, const std::shared_ptr<const TracedScene>& traced);
void addExposure(std::vector<Control>& controls);
// method_controls.cpp: of A or B, with the bias files of `state`
void addSide(std::vector<Control>& controls, size_t side, float sceneScale, const ViewState& state);

}  // namespace gnomon
