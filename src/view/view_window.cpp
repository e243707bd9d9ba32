#include "view/view_window.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/message.h"
#include "base/terminal.h"
#include "lab/core/method.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>
#include <vulkan/vulkan.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

// Without a change for so long, all is at rest.
constexpr std::chrono::milliseconds kRest{150};
// A device that is lost again so soon is not made anew.
constexpr std::chrono::seconds kOftenLost{5};
// A window looks around so often, seconds: when nothing happens, while something moves, while a script waits.
constexpr double kIdle = 0.25, kWhileMoving = 0.015, kWhileScripted = 0.02;

double msBetween(ViewClock::time_point from, ViewClock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

// Since the program was started, milliseconds: the start of this process, whatever it was then.
double msSinceStart() {
  std::ifstream file("/proc/self/stat");
  std::string text;
  std::getline(file, text);
  const size_t end = text.rfind(')');
  if (end == std::string::npos) return 0.0;
  std::istringstream words(text.substr(end + 2));
  std::string word;
  for (int i = 0; i < 20; ++i) words >> word;  // the 22nd of the line
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const double ticks = std::stod(word) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return 1e3 * (static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) - ticks);
}

std::string lastGlfwError;

}  // namespace

double StageHistory::median() const {
  return gnomon::median({ms.begin(), ms.end()});
}

ViewWindow::ViewWindow(const ViewOptions& options) : options_(options), state_(options.state) {
  std::vector<ScriptLine> lines;
  if (!options.script.empty()) lines = readScript(options.script);
  if (!options.session.empty() && std::filesystem::exists(options.session)) {
    state_ = readSession(options.session, readSessionFile(options.session), state_);
    if (options.namesOthers)
      std::fprintf(stderr, "gnomon: note: what the session %s sets comes before the command line\n",
                   printable(options.session).c_str());
  }
  goodState_ = state_;
  // The picture is under way while the window is made.
  worker_ = std::make_unique<PictureWorker>(gpu::DeviceOptions{.name = options.device}, [] { glfwPostEmptyEvent(); });
  createWindow();
  remakeControls();
  current_ = sessionJson(state_);
  if (!options.script.empty()) script_ = std::make_unique<ScriptPlayer>(*this, options.script, std::move(lines));
  lastChange_ = lastFrame_ = inputTime_ = ViewClock::now();
}

ViewWindow::~ViewWindow() {
  worker_.reset();
  if (presenter_) {
    presenter_.reset();
    ImGui_ImplGlfw_Shutdown();
  }
  if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

void ViewWindow::createWindow() {
  glfwSetErrorCallback([](int, const char* text) { lastGlfwError = text; });
  if (glfwInit() != GLFW_TRUE)
    throw WorldError(fmt::format("no window can be opened: {}; set DISPLAY, or run `xvfb-run -a gnomon view ...`",
                                 lastGlfwError.empty() ? "there is no display" : lastGlfwError));
  if (glfwVulkanSupported() != GLFW_TRUE)
    throw WorldError("no window can be opened: no Vulkan driver was found; apt-get install mesa-vulkan-drivers");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(options_.width, options_.height, "Gnomon", nullptr, nullptr);
  if (window_ == nullptr) throw WorldError(fmt::format("no window can be opened: {}", lastGlfwError));
  glfwSetWindowUserPointer(window_, this);
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    auto* self = static_cast<ViewWindow*>(glfwGetWindowUserPointer(window));
    for (int i = 0; i < count; ++i) self->dropped_.emplace_back(paths[i]);
  });
  // Before ImGui's, which calls it.
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
    if (action != GLFW_PRESS || key < 0 || (key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER)) return;
    auto* self = static_cast<ViewWindow*>(glfwGetWindowUserPointer(window));
    const bool isOfOthers = (mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;  // the desktop's
    if (isOfOthers || (mods & GLFW_MOD_CONTROL) != 0)
      self->pressedWithModifier_.insert(key);
    else
      self->pressedWithModifier_.erase(key);
    if (isOfOthers) return;
    self->input_.emplace_back(KeyTap{key, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0});
  });
  float scaleX = 1.0f, scaleY = 1.0f;
  glfwGetWindowContentScale(window_, &scaleX, &scaleY);
  scale_ = options_.scale > 0.0 ? static_cast<float>(options_.scale) : std::max(scaleX, 1.0f);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  ImFontConfig font;
  font.SizePixels = std::round(13.0f * scale_);
  io.Fonts->AddFontDefault(&font);
  ImGui::StyleColorsDark();
  ImGui::GetStyle().ScaleAllSizes(scale_);
  ImGui::GetStyle().WindowRounding = 0.0f;
  ImGui_ImplGlfw_InitForVulkan(window_, true);
  listenToInput();
  io.KeyMap[ImGuiKey_Tab] = -1;  // the split's, and not the next text's
  try {
    presenter_ = std::make_unique<Presenter>(window_, options_.device);
  } catch (...) {
    ImGui_ImplGlfw_Shutdown();
    throw;
  }
}

// ---- requests and pictures ----

// Nothing has changed for a while, and the picture of the last change is on the window.
bool ViewWindow::isAtRest() const {
  return ViewClock::now() - lastChange_ >= kRest && drag_ == Drag::None && shownNumber_ >= number_;
}

void ViewWindow::ask() {
  const auto [width, height] = pictureSize();
  if (width != askedWidth_ || height != askedHeight_) {
    changed_ = true;
    askedWidth_ = width;
    askedHeight_ = height;
  }
  const bool rests = isAtRest();
  if (changed_) {
    inputTimes_[++number_] = inputTime_;
    worker_->ask({.state = state_, .number = number_, .moving = goesOn_, .width = width, .height = height});
    restAsked_ = !goesOn_;
    changed_ = false;
    if (!goesOn_ && drag_ == Drag::None) rememberState();
    return;
  }
  if (rests && !restAsked_) {
    worker_->ask({.state = state_, .number = number_, .moving = false, .width = width, .height = height});
    restAsked_ = true;
    goesOn_ = false;
    rememberState();
  }
}

void ViewWindow::takePicture() {
  const std::shared_ptr<const ViewPicture> newest = worker_->newest();
  if (!newest || newest == picture_) return;
  picture_ = newest;
  // This frame, and at rest one more, in which the interface has settled.
  framesPending_ = std::max(framesPending_, goesOn_ ? 1 : 2);
  const bool isNews = newest->problem != std::exchange(pictureProblem_, newest->problem);
  if (!newest->problem.empty()) {
    if (isNews) say(newest->problem, true);
    framesPending_ = 3;  // its box has the size that it asked for a frame before
    // The files that are shown are those that were.
    if (newest->number != number_) return;
    const bool lostScene = newest->sceneFailed && goodState_.setup.scene != state_.setup.scene;
    const bool lostDensity = goodState_.fog.density != state_.fog.density;
    if (lostScene) state_.setup = goodState_.setup;
    if (lostDensity) {
      state_.fog = goodState_.fog;
      noteChange(false);
    }
    // What could not be opened is no step to go back to; whatever else is wrong is one, as any change.
    if (lostScene || lostDensity) current_ = sessionJson(state_);
    return;
  }
  if (newest->number == number_ && !changed_) goodState_ = state_;
  if (newest->traced && newest->traced != traced_) {
    traced_ = newest->traced;
    remakeControls();
    pivot_.reset();
    glfwSetWindowTitle(window_, fmt::format("Gnomon: {}", traced_->scene.name).c_str());
    if (!traced_->scene.notes.empty()) say("note: " + traced_->scene.notes.front(), false);
  }
  if (newest->number == number_)
    for (size_t side = 0; side < kSideCount; ++side)
      if (state_.sides[side].mapByLight && traced_) chooseMapsByLight(state_, traced_->tracer);
  uploadPictures();
  // The same picture, and more known of it.
  const bool isKnown = newest->number == timedNumber_ && !newest->stages.empty();
  timedNumber_ = newest->number;
  for (const ViewStage& stage : newest->stages) {
    if (isKnown && stage.name != std::string_view("labels")) continue;
    auto found = std::ranges::find(times_, stage.name, &StageHistory::name);
    if (found == times_.end()) found = times_.insert(times_.end(), StageHistory{.name = stage.name});
    found->ms.push_back(static_cast<float>(stage.ms));
    if (found->ms.size() > kMostTimes) found->ms.pop_front();
  }
}

// ---- what is shown ----

// Each side its part of the picture's place; what a map holds is no picture of the camera and is shown whole in there.
std::vector<Presenter::Shown> ViewWindow::shownPictures() const {
  std::vector<Presenter::Shown> shown;
  if (!picture_ || place_.rect.width == 0 || picture_->sides[0].image.values.empty()) return shown;
  const bool hasB = state_.split && !picture_->sides[1].image.values.empty();
  const double at = hasB ? std::clamp(state_.splitAt, 0.0, 1.0) : 1.0;
  const int cut = static_cast<int>(std::lround(at * place_.rect.width));
  const int fromCut = static_cast<int>(std::lround(at * picture_->width));
  const PixelRect& to = place_.rect;
  for (int side = 0; side < (hasB ? 2 : 1); ++side) {
    const bool isA = side == 0;
    const PixelRect part{isA ? to.x : to.x + cut, to.y, isA ? cut : to.width - cut, to.height};
    const Image8& image = picture_->sides[static_cast<size_t>(side)].image;
    if (isOfCamera(side)) {
      const PixelRect from{isA ? 0 : fromCut, 0, isA ? fromCut : picture_->width - fromCut, picture_->height};
      shown.push_back({.slot = side, .from = from, .to = part});
      continue;
    }
    const double scale =
        std::min(static_cast<double>(part.width) / image.width, static_cast<double>(part.height) / image.height);
    const int width = static_cast<int>(scale * image.width), height = static_cast<int>(scale * image.height);
    shown.push_back({.slot = side,
                     .from = {0, 0, image.width, image.height},
                     .to = {part.x + (part.width - width) / 2, part.y + (part.height - height) / 2, width, height}});
  }
  if (unfoldedRect_.width > 0 && unfoldedWidth_ > 0)
    shown.push_back({.slot = 2, .from = {0, 0, unfoldedWidth_, unfoldedHeight_}, .to = unfoldedRect_});
  return shown;
}

bool ViewWindow::isOfCamera(int side) const {
  const Image8& image = picture_->sides[static_cast<size_t>(side)].image;
  return image.width == picture_->width && image.height >= picture_->height;
}

void ViewWindow::uploadPictures() {
  if (!picture_) return;
  for (int side = 0; side < kSideCount; ++side)
    if (const Image8& image = picture_->sides[static_cast<size_t>(side)].image; !image.values.empty())
      presenter_->setPicture(side, image);
  if (const Image8& unfolded = picture_->sides[0].unfolded; !unfolded.values.empty()) {
    presenter_->setPicture(2, unfolded);
    unfoldedWidth_ = unfolded.width;
    unfoldedHeight_ = unfolded.height;
  }
}

// A window's device that is lost is made anew, once in a while; the state stays.
void ViewWindow::present() {
  try {
    presenter_->present(shownPictures(), ImGui::GetDrawData(), keepFrame_);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    const bool isLoss = what.find("VK_ERROR_DEVICE_LOST") != std::string::npos ||
                        what.find("VK_ERROR_SURFACE_LOST") != std::string::npos;
    if (!isLoss || ViewClock::now() - lastLoss_ < kOftenLost) throw;
    remakePresenter();
    say(what + "; the window's device was made anew", true);
  }
}

void ViewWindow::remakePresenter() {
  lastLoss_ = ViewClock::now();
  const size_t messages = presenter_->validationMessages();
  presenter_.reset();
  presenter_ = std::make_unique<Presenter>(window_, options_.device);
  forgottenMessages_ += messages;
  unfoldedWidth_ = 0;
  uploadPictures();
  framesPending_ = 3;
}

// ---- the loop ----

void ViewWindow::frame() {
  const ViewClock::time_point now = ViewClock::now();
  frameSeconds_ = std::clamp(static_cast<float>(msBetween(lastFrame_, now) * 1e-3), 0.001f, 0.1f);
  lastFrame_ = now;
  inputTime_ = now;
  openDropped();
  takePicture();
  followBiasFiles();
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  const auto heldKeys = std::to_array(io.KeysDown);
  const bool heldCtrl = io.KeyCtrl, heldShift = io.KeyShift;
  const std::optional<KeyTap> taken = takeInput();
  const KeyTap tap = taken.value_or(KeyTap{});
  if (scripted_.drives) {
    io.MousePos = ImVec2(scripted_.x, scripted_.y);
    for (int i = 0; i < 3; ++i) io.MouseDown[i] = scripted_.buttons[i];
    io.MouseWheel += scripted_.wheel;
    scripted_.wheel = 0.0f;
  }
  for (const int key : scripted_.keys) io.KeysDown[key] = true;
  io.KeyCtrl = (taken ? tap.ctrl : heldCtrl) || scripted_.ctrl;
  io.KeyShift = (taken ? tap.shift : heldShift) || scripted_.shift;
  ImGui::NewFrame();
  const bool isTyping = io.WantTextInput && ImGui::IsAnyItemActive();  // the first alone stays for a frame
  layOut();
  drawPanels();
  drawCanvas();
  if (!isTyping) handleKeys(tap);
  handleMouse();
  ask();
  ImGui::Render();
  std::ranges::copy(heldKeys, io.KeysDown);
  io.KeyCtrl = heldCtrl;
  io.KeyShift = heldShift;
  present();
  ++framesDrawn_;
  keepFrame_ = false;
  if (redrawKept_) {
    redrawKept_ = false;
    guarded([&] {
      const std::string path = freeName("gnomon-view-window");
      writePng(path, presenter_->kept());
      say("wrote " + path, false);
    });
  }
  if (picture_ && (picture_->number > shownNumber_ || presentedPictures_ == 0) &&
      !picture_->sides[0].image.values.empty()) {
    const ViewClock::time_point done = ViewClock::now();
    if (presentedPictures_++ == 0) firstPictureMs_ = msSinceStart();
    shownNumber_ = picture_->number;
    if (const auto found = inputTimes_.find(shownNumber_); found != inputTimes_.end()) {
      latencies_.push_back(msBetween(found->second, done));
      if (latencies_.size() > 100000) latencies_.erase(latencies_.begin(), latencies_.begin() + 50000);
      inputTimes_.erase(inputTimes_.begin(), std::next(found));
    }
  }
}

// Whether there is anything to draw a frame for: the cores are for the pictures.
bool ViewWindow::wantsFrame() const {
  const bool restIsDue = !restAsked_ && isAtRest();
  const bool plays = script_ != nullptr && !script_->isDone() && !scriptWaits_;
  const bool counts = options_.frames && framesDrawn_ < *options_.frames && (!script_ || script_->isDone());
  return framesPending_ > 0 || !input_.empty() || opensDropped() || changed_ || drag_ != Drag::None || restIsDue ||
         plays || counts || worker_->newest() != picture_;
}

// Until something happens, or there is something to draw all the same.
void ViewWindow::waitForEvents() {
  if (wantsFrame()) return glfwPollEvents();
  const bool goesOn = !restAsked_;  // a key may be held
  const bool waits = script_ != nullptr || options_.frames.has_value();
  const double seconds = goesOn || check_ ? kWhileMoving : waits ? kWhileScripted : kIdle;
  const ViewClock::time_point before = ViewClock::now();
  glfwWaitEventsTimeout(seconds);
  const bool happened = msBetween(before, ViewClock::now()) < 980.0 * seconds;
  const bool isOver = !message_.empty() && ViewClock::now() - messageTime_ > kMessage;
  if (happened && !waits) framesPending_ = 3;
  if ((goesOn && !script_) || isOver) framesPending_ = std::max(framesPending_, 1);
}

int ViewWindow::run() {
  while (!quits_ && glfwWindowShouldClose(window_) == GLFW_FALSE) {
    waitForEvents();
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE && !script_) {
      glfwWaitEventsTimeout(kIdle);
      continue;
    }
    scriptWaits_ = false;
    if (script_ && !script_->step() && !options_.frames) break;
    if (!wantsFrame()) {
      const bool isRefined =
          picture_ && picture_->number == number_ && picture_->refined && worker_->isIdle() && restAsked_;
      if (options_.frames && (!script_ || script_->isDone()) && isRefined) break;
      continue;
    }
    frame();
    if (framesPending_ > 0) --framesPending_;
  }
  if (!options_.screenshot.empty()) {
    keepFrame_ = true;
    frame();
    writePng(options_.screenshot, presenter_->kept());
    gnomon::say(fmt::format("wrote {}\n", options_.screenshot));
  }
  if (!options_.picture.empty()) {
    writePictureFile(options_.picture, 0);
    gnomon::say(fmt::format("wrote {}\n", options_.picture));
  }
  if (!options_.json.empty()) writeJson();
  const size_t messages = worker_->validationMessages() + presenter_->validationMessages() + forgottenMessages_;
  if (messages > 0) throw WorldError(fmt::format("the validation layers have {} messages", messages));
  if (options_.frames && !pictureProblem_.empty())
    throw WorldError((options_.session.empty() ? "" : printable(options_.session) + ": ") + pictureProblem_);
  return 0;
}

void ViewWindow::writeJson() const {
  const auto latency = [](const std::vector<double>& values) {
    nlohmann::ordered_json json;
    json["count"] = values.size();
    json["median_ms"] = median(values);
    json["max_ms"] = values.empty() ? 0.0 : *std::ranges::max_element(values);
    return json;
  };
  nlohmann::ordered_json json;
  json["gnomon_view"] = 1;
  json["command"] = statusCommand();
  json["first_picture_ms"] = firstPictureMs_;
  json["pictures"] = presentedPictures_;
  json["frames"] = framesDrawn_;
  json["latency"] = latency(latencies_);
  auto measured = nlohmann::ordered_json::array();
  for (const Measurement& one : measurements_) {
    nlohmann::ordered_json entry;
    entry["name"] = one.name;
    entry["seconds"] = one.seconds;
    entry["pictures"] = one.pictures;
    entry["pictures_per_second"] = one.seconds > 0.0 ? one.pictures / one.seconds : 0.0;
    entry["frames_per_second"] = one.seconds > 0.0 ? one.frames / one.seconds : 0.0;
    entry["latency"] = latency(one.latencies);
    entry["share_of_side"] = median(one.shares);
    entry["map_halvings"] = median(one.halvings);
    measured.push_back(entry);
  }
  json["measured"] = measured;
  auto stages = nlohmann::ordered_json::object();
  for (const StageHistory& stage : times_) stages[stage.name] = stage.median();
  json["stage_median_ms"] = stages;
  writeTextFile(options_.json, json.dump(2) + "\n");
}

int runWindow(const ViewOptions& options) {
  ViewWindow window(options);
  try {
    return window.run();
  } catch (const std::exception& error) {
    // What a person set is not lost with the window.
    if (!options.script.empty() || options.frames) throw;
    throw WorldError(fmt::format("{}; what was set is in {}", error.what(), window.rescueSession()));
  }
}

}  // namespace gnomon
