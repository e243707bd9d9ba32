// What a person sets, takes back, opens, saves and copies.

#include "view/view_window.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "view/control_kinds.h"

#include <algorithm>
#include <filesystem>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gnomon {

void ViewWindow::say(const std::string& line, bool isProblem) {
  message_ = line;
  messageIsProblem_ = isProblem;
  messageTime_ = ViewClock::now();
  framesPending_ = std::max(framesPending_, 2);
}

void ViewWindow::noteChange(bool goesOn) {
  changed_ = true;
  goesOn_ = goesOn;
  if (!messageIsProblem_) message_.clear();  // it was about what was done before
  lastChange_ = ViewClock::now();
}

void ViewWindow::rememberState() {
  const std::string now = sessionJson(state_);
  if (now == current_) return;
  past_.push_back(std::exchange(current_, now));
  constexpr size_t kMostStates = 500;
  if (past_.size() > kMostStates) past_.erase(past_.begin());
  future_.clear();
}

void ViewWindow::undo() {
  rememberState();
  if (past_.empty()) return say("nothing to undo", false);
  guarded([&] {
    state_ = readPastState("undo", past_.back(), state_);
    future_.push_back(std::exchange(current_, past_.back()));
    past_.pop_back();
    noteChange(false);
  });
}

void ViewWindow::redo() {
  rememberState();
  if (future_.empty()) return say("nothing to redo", false);
  guarded([&] {
    state_ = readPastState("redo", future_.back(), state_);
    past_.push_back(std::exchange(current_, future_.back()));
    future_.pop_back();
    noteChange(false);
  });
}

void ViewWindow::remakeControls() {
  controls_ = viewControls(traced_, state_);
  controlsFiles_ = chosenBiasFiles(state_);
}

void ViewWindow::followBiasFiles() {
  if (chosenBiasFiles(state_) != controlsFiles_) remakeControls();
}

// By value: a control's own name and choices are gone when controls are made anew.
void ViewWindow::setControl(std::string name, std::string value) {
  followBiasFiles();
  const Control& control = findControl(controls_, name);
  ViewState changed = state_;
  control.set(changed, value);
  state_ = changed;
  noteChange(false);
}

std::string ViewWindow::getControl(std::string name) {
  followBiasFiles();
  return findControl(controls_, name).get(state_);
}

void ViewWindow::openFile(const std::string& path) {
  checkNoStream(path);
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".gltf" || extension == ".glb") {
    setControl("scene", path);
  } else if (extension == ".vdb") {
    state_.fog.on = true;
    state_.fog.density = path;
  } else if (extension == ".json") {
    state_ = readSession(path, readSessionFile(path), state_);
  } else if (extension == ".glsl") {
    setControl("a.bias", path);
  } else {
    throw UsageError(path + ": drop a scene (.gltf, .glb), a density (.vdb), a bias (.glsl) or a session (.json)");
  }
  pivot_.reset();
  noteChange(false);
}

// One after the other; what asks for the compiler is checked beside the window first.
void ViewWindow::openDropped() {
  for (; !dropped_.empty(); dropped_.pop_front()) {
    const std::string path = dropped_.front();
    std::error_code failure;
    if (!check_ && FileCheck::isFor(path) && std::filesystem::is_regular_file(path, failure)) {
      check_.emplace(path, state_);
      say("reading " + path, false);
    }
    if (check_ && !check_->isDone()) return;
    guarded([&] {
      if (const auto check = std::exchange(check_, std::nullopt)) check->rethrow();
      openFile(path);
    });
  }
}

// Whether a frame would open something.
bool ViewWindow::opensDropped() const {
  return !dropped_.empty() && (!check_ || check_->isDone());
}

void ViewWindow::saveSession(const std::string& path) {
  writeTextFile(path, sessionJson(state_, path));
  say("saved " + path, false);
}

std::string ViewWindow::freeName(const std::string& stem) {
  for (int i = 1;; ++i)
    if (std::string name = fmt::format("{}-{:04}.png", stem, i); !std::filesystem::exists(name)) return name;
}

void ViewWindow::writePictureFile(const std::string& path, int side) {
  if (side == 1 && !state_.split) throw UsageError("B is not shown; turn the split on (`set split on`, or Tab)");
  if (!pictureProblem_.empty()) throw WorldError("there is no picture of this: " + pictureProblem_);
  if (!picture_ || picture_->sides[static_cast<size_t>(side)].image.values.empty())
    throw WorldError("there is no picture yet; let `wait-refined` come first");
  writePng(path, picture_->sides[static_cast<size_t>(side)].image);
  say("wrote " + path, false);
}

std::pair<int, int> ViewWindow::pictureSize() const {
  if (!state_.setup.size.empty()) {
    const PictureSize size = parseSize(state_.setup.size);
    return {size.width, size.height};
  }
  return {std::max(canvas_.width, 16), std::max(canvas_.height - unfoldedRoom_, 16)};
}

std::vector<std::string> ViewWindow::statusCommands() const {
  const auto [width, height] = pictureSize();
  if (!state_.split) return {pictureCommand(state_, 0, width, height, "picture.png")};
  return {pictureCommand(state_, 0, width, height, "a.png"), pictureCommand(state_, 1, width, height, "b.png")};
}

std::string ViewWindow::statusCommand() const {
  return fmt::format("{}", fmt::join(statusCommands(), " && "));
}

std::string ViewWindow::compareCommandOfSides() const {
  const auto [width, height] = pictureSize();
  return comparisonCommand(state_, width, height);
}

void ViewWindow::copyCommand(bool ofComparison) {
  const std::string command = ofComparison ? compareCommandOfSides() : statusCommand();
  glfwSetClipboardString(window_, command.c_str());
  say("copied: " + command, false);
}

std::string ViewWindow::rescueSession() const {
  const std::string path = options_.session.empty() ? "gnomon-view.json" : options_.session;
  writeTextFile(path, sessionJson(state_, path));
  return path;
}

}  // namespace gnomon
