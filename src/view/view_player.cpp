// Plays scripts: inputs as a person gives them, what is to be written, what is measured.

#include "view/view_window.h"

#include "base/error.h"
#include "base/image.h"
#include "base/process_memory.h"
#include "base/terminal.h"
#include "lab/fog/fog_motion.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <random>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

namespace gnomon {

// Of the window, that one line of a script takes.
constexpr int kMostSteps = 10'000'000;

int keyNamed(const std::string& name) {
  static const std::map<std::string, int> named = {
      {"tab", GLFW_KEY_TAB},        {"escape", GLFW_KEY_ESCAPE},   {"f1", GLFW_KEY_F1},     {"left", GLFW_KEY_LEFT},
      {"right", GLFW_KEY_RIGHT},    {"up", GLFW_KEY_UP},           {"down", GLFW_KEY_DOWN}, {"home", GLFW_KEY_HOME},
      {"space", GLFW_KEY_SPACE},    {"enter", GLFW_KEY_ENTER},     {",", GLFW_KEY_COMMA},   {".", GLFW_KEY_PERIOD},
      {"[", GLFW_KEY_LEFT_BRACKET}, {"]", GLFW_KEY_RIGHT_BRACKET}, {"/", GLFW_KEY_SLASH}};
  if (const auto found = named.find(name); found != named.end()) return found->second;
  if (name.size() != 1) return -1;
  const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : -1;
}

ScriptPlayer::ScriptPlayer(ViewWindow& window, std::string name, std::vector<ScriptLine> lines)
    : window_(window), name_(std::move(name)), lines_(std::move(lines)) {}

void ScriptPlayer::fail(const ScriptLine& line, const std::string& what) const {
  throw WorldError(fmt::format("{}:{}: {}", name_, line.number, what));
}

bool ScriptPlayer::isRefined() const {
  const ViewWindow& w = window_;
  return w.picture_ && w.picture_->number == w.number_ && w.picture_->refined && w.restAsked_ && !w.changed_ &&
         w.worker_->isIdle() && w.worker_->newest() == w.picture_;
}

// A wait ends, at the latest, when nothing has come for so long.
void ScriptPlayer::checkPatience(const ScriptLine& line) {
  constexpr std::chrono::seconds kPatience{120};
  const ViewClock::time_point now = ViewClock::now();
  const ViewPicture* const newest = window_.worker_->newest().get();
  if (newest != seen_ || !window_.scriptWaits_) lastSign_ = now;
  seen_ = newest;
  if (now - lastSign_ > kPatience && !window_.options_.script.empty())
    fail(line, fmt::format("no picture in {} s", kPatience.count()));
}

// Pixels of a picture are somewhere only when there is one; a light has a place only in a scene.
bool ScriptPlayer::lacksScene(const ScriptLine& line) const {
  const ViewWindow& w = window_;
  if (!w.pictureProblem_.empty()) return false;
  if (line.verb == "move" || line.verb == "drag") return w.place_.rect.width == 0;
  if (line.verb == "controls") return !w.traced_;
  if (line.verb != "set" && line.verb != "expect") return false;
  const auto named = std::ranges::find(w.controls_, line.words[0], &Control::name);
  return named != w.controls_.end() && named->derived && !w.traced_;
}

bool ScriptPlayer::step() {
  while (true) {
    if (waiting_) {
      if (waiting_()) {
        checkPatience(lines_[at_ - 1]);
        return true;
      }
      waiting_ = nullptr;
    }
    window_.scriptWaits_ = !window_.dropped_.empty();  // until it is opened, which has limits of its own
    if (window_.scriptWaits_) return true;
    if (at_ >= lines_.size()) {
      // A person's window goes on without it.
      return window_.options_.script.empty();
    }
    const ScriptLine& line = lines_[at_];
    window_.scriptWaits_ = lacksScene(line);
    if (window_.scriptWaits_) {
      checkPatience(line);
      return true;
    }
    ++at_;
    try {
      play(line);
    } catch (const std::exception& error) {
      if (window_.options_.script.empty()) {
        window_.say(error.what(), true);
        at_ = lines_.size();
        return true;
      }
      const std::string place = fmt::format("{}:{}: ", name_, line.number);
      const std::string what = error.what();
      throw WorldError(what.starts_with(place) ? what : place + what);
    }
    if (window_.quits_) return false;
  }
}

void ScriptPlayer::moveTo(double x, double y) {
  const PicturePlace& place = window_.place_;
  window_.scripted_.drives = true;
  // The middle of a pixel of the full picture.
  window_.scripted_.x = static_cast<float>(place.rect.x + (x + 0.5) * static_cast<double>(place.scale));
  window_.scripted_.y = static_cast<float>(place.rect.y + (y + 0.5) * static_cast<double>(place.scale));
}

void ScriptPlayer::pressKey(const std::string& text, int frames) {
  std::string name = text;
  ScriptedInput& input = window_.scripted_;
  input.ctrl = input.shift = false;
  for (const auto& [prefix, held] : {std::pair{"ctrl+", &input.ctrl}, std::pair{"shift+", &input.shift}}) {
    if (!name.starts_with(prefix)) continue;
    *held = true;
    name = name.substr(std::string(prefix).size());
  }
  if (name == "?") {
    window_.input_.push_back(U'?');
    return wait([frames]() mutable { return frames-- > 0; });
  }
  const int key = keyNamed(name);
  if (key < 0) throw WorldError(fmt::format("{}: no such key; write one as q, 7, tab, f1 or left", text));
  input.keys = {key};
  window_.input_.push_back(KeyTap{key, input.ctrl, input.shift});
  wait([this, frames]() mutable {
    if (frames-- > 0) return true;
    window_.scripted_.keys.clear();
    window_.scripted_.ctrl = window_.scripted_.shift = false;
    return frames >= -2;  // and a frame without it
  });
}

void ScriptPlayer::playInput(const ScriptLine& line) {
  ScriptedInput& input = window_.scripted_;
  const auto number = [&](size_t word) { return scriptNumber(name_, line, word); };
  const auto count = [&](size_t word, int most) { return scriptCount(name_, line, word, 1, most); };
  const auto button = [&](size_t word) { return scriptChoice(name_, line, word, {"left", "right", "middle"}); };
  const auto oneFrame = [this] { wait([frames = 1]() mutable { return frames-- > 0; }); };
  if (line.verb == "key") return pressKey(line.words[0], 1);
  if (line.verb == "hold") return pressKey(line.words[0], count(1, kMostSteps));
  if (line.verb == "move") {
    moveTo(number(0), number(1));
    return wait([frames = 2]() mutable { return frames-- > 0; });
  }
  if (line.verb == "window-move") {
    input.drives = true;
    input.x = static_cast<float>(number(0));
    input.y = static_cast<float>(number(1));
    return wait([frames = 2]() mutable { return frames-- > 0; });
  }
  if (line.verb == "down" || line.verb == "up") {
    input.drives = true;
    input.buttons[button(0)] = line.verb == "down";
    return oneFrame();
  }
  if (line.verb == "scroll") {
    input.wheel = static_cast<float>(number(0));
    return oneFrame();
  }
  // drag
  const double x0 = number(0), y0 = number(1), x1 = number(2), y1 = number(3);
  const int steps = line.words.size() > 4 ? count(4, kMostSteps) : 8;
  const size_t pressed = button(5);
  moveTo(x0, y0);
  wait([this, x0, y0, x1, y1, steps, pressed, at = -2]() mutable {
    ++at;
    if (at < 0) return true;
    if (at == 0) window_.scripted_.buttons[pressed] = true;
    if (at > 0 && at <= steps) {
      const double share = static_cast<double>(at) / steps;
      moveTo(x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    }
    if (at == steps + 1) window_.scripted_.buttons[pressed] = false;
    return at <= steps + 2;
  });
}

// Each step follows when the picture of the one before is there; what it takes is measured.
void ScriptPlayer::animate(const ScriptLine& line) {
  const bool isLight = scriptChoice(name_, line, 0, {"light", "camera"}) == 0;
  const double degrees = scriptNumber(name_, line, 1);
  const int count = scriptCount(name_, line, 2, 1, kMostSteps);
  auto measured = std::make_shared<Measurement>(Measurement{.name = fmt::format("{} moves", line.words[0])});
  auto start = std::make_shared<ViewClock::time_point>();
  wait([this, isLight, degrees, count, measured, start, done = -1, framesAt = 0, latenciesAt = size_t{0}]() mutable {
    ViewWindow& w = window_;
    const auto newest = w.worker_->newest();
    const bool arrived = newest && w.traced_ && newest->number >= w.number_ && !w.changed_;
    w.scriptWaits_ = !arrived;
    if (done < 0) {
      w.scriptWaits_ = !isRefined();
      if (w.scriptWaits_) return true;
      done = 0;
      *start = ViewClock::now();
      framesAt = w.framesDrawn_;
      latenciesAt = w.latencies_.size();
    } else if (!arrived) {
      return true;
    } else {
      ++done;
      measured->shares.push_back(static_cast<double>(newest->width) / std::max(newest->fullWidth, 1));
      measured->halvings.push_back(newest->mapHalvings);
    }
    if (done >= count) {
      measured->seconds = std::chrono::duration<double>(ViewClock::now() - *start).count();
      measured->pictures = count;
      measured->frames = w.framesDrawn_ - framesAt;
      measured->latencies.assign(
          w.latencies_.begin() + static_cast<std::ptrdiff_t>(std::min(latenciesAt, w.latencies_.size())),
          w.latencies_.end());
      w.measurements_.push_back(*measured);
      return false;
    }
    w.inputTime_ = ViewClock::now();
    if (isLight)
      w.turnLight(degrees / count, 0.0);
    else
      w.turnCamera(degrees / count);
    w.noteChange(true);
    return true;
  });
}

void ScriptPlayer::rest(int frames) {
  auto start = std::make_shared<ViewClock::time_point>(ViewClock::now());
  wait([this, frames, start, at = 0]() mutable {
    if (at == 0) *start = ViewClock::now();
    if (at++ < frames) return true;
    window_.measurements_.push_back({.name = "at rest",
                                     .pictures = 0,
                                     .frames = frames,
                                     .seconds = std::chrono::duration<double>(ViewClock::now() - *start).count()});
    return false;
  });
}

void ScriptPlayer::turntable(const ScriptLine& line) {
  const std::filesystem::path folder = line.words[0];
  const int frames = scriptCount(name_, line, 1, 2, 9999);
  const bool isLight = scriptChoice(name_, line, 2, {"camera", "light"}) == 1;
  const ViewState before = window_.state_;
  wait([this, folder, frames, isLight, before, at = 0]() mutable {
    ViewWindow& w = window_;
    w.scriptWaits_ = !isRefined();
    if (w.scriptWaits_) return true;
    w.writePictureFile((folder / "frames" / fmt::format("{:04}.png", at)).string(), 0);
    if (++at < frames) {
      w.state_ = before;
      if (isLight)
        w.turnLight(360.0 * at / frames, 0.0);
      else
        w.turnCamera(360.0 * at / frames);
      w.noteChange(false);
      return true;
    }
    w.state_ = before;
    w.noteChange(false);
    w.say(folder.string() + ": " + writeVideos(folder, {"frames"}), false);
    return false;
  });
}

// What no person would do, one thing after the other: where the mouse goes, keys, controls, sizes.
void ScriptPlayer::random(int frames, unsigned seed) {
  auto engine = std::make_shared<std::mt19937>(seed);
  wait([this, engine, left = frames]() mutable {
    ViewWindow& w = window_;
    if (left-- <= 0) {
      w.scripted_ = {};
      return false;
    }
    const auto below = [&](int n) { return static_cast<int>((*engine)() % static_cast<unsigned>(n)); };
    ScriptedInput& input = w.scripted_;
    input.drives = true;
    input.keys.clear();
    input.ctrl = input.shift = false;
    switch (below(12)) {
      case 0:
        input.x = static_cast<float>(below(w.options_.width));
        input.y = static_cast<float>(below(w.options_.height));
        break;
      case 1:
        input.buttons[below(3)] = below(2) == 0;
        break;
      case 2: {
        // Not those that write files or end it.
        constexpr std::array kKeys = {"tab", "l", "m", "f", "g", "h", "x", ",",      ".",    "w", "a",
                                      "d",   "e", "1", "2", "3", "4", "5", "escape", "home", "f1"};
        input.keys = {keyNamed(kKeys[static_cast<size_t>(below(static_cast<int>(kKeys.size())))])};
        input.shift = below(4) == 0;
        w.input_.push_back(KeyTap{input.keys.front(), false, input.shift});
        break;
      }
      case 3: {
        const Control& control = w.controls_[static_cast<size_t>(below(static_cast<int>(w.controls_.size())))];
        w.guarded([&] {
          std::string value;
          if (control.name == "scene" || control.name == "size" || control.name.find("vsv-size") != std::string::npos)
            return;
          if (control.kind == Control::Kind::Choice)
            value = control.choices[static_cast<size_t>(below(static_cast<int>(control.choices.size())))];
          else if (control.kind == Control::Kind::Toggle)
            value = below(2) == 0 ? "on" : "off";
          else if (control.kind == Control::Kind::Number || control.kind == Control::Kind::Whole)
            value = fmt::format("{}",
                                control.slideLower + (control.slideUpper - control.slideLower) * below(1001) / 1000.0);
          else if (!control.choices.empty())
            value = control.choices[static_cast<size_t>(below(static_cast<int>(control.choices.size())))];
          if (control.name.ends_with("map-size")) value = fmt::format("{}", 16 << below(6));
          if (control.name.ends_with("integrator") && value == kReferenceIntegrator) value = "runs";
          if (control.name.ends_with("cascades")) value = fmt::format("{}", 1 + below(4));
          w.setControl(control.name, value);
        });
        break;
      }
      case 4:
        input.wheel = static_cast<float>(below(3) - 1);
        break;
      case 5:
        if (below(30) == 0) glfwSetWindowSize(w.window_, 200 + below(w.options_.width), 150 + below(w.options_.height));
        break;
      case 6:
        if (below(4) == 0) w.undo();
        break;
      case 7:
        if (below(4) == 0) w.redo();
        break;
      case 8:
        if (below(60) == 0) w.guarded([&] { w.openFile("no/such/scene.glb"); });
        break;
      case 9:
        if (below(60) == 0) w.worker_->loseDevice();
        break;
      default:
        input.x += static_cast<float>(below(41) - 20);
        input.y += static_cast<float>(below(41) - 20);
    }
    return true;
  });
}

void ScriptPlayer::playOutput(const ScriptLine& line) {
  ViewWindow& w = window_;
  if (line.verb == "screenshot") {
    const std::string file = line.words[0];
    return wait([this, file, at = 0]() mutable {
      // The interface settles in two frames.
      if (at++ < 2) return true;
      if (at == 3) {
        if (!window_.messageIsProblem_) window_.message_.clear();  // "saved ...": of the script itself
        window_.keepFrame_ = true;
        return true;
      }
      writePng(file, window_.presenter_->kept());
      gnomon::say(fmt::format("wrote {}\n", file));
      return false;
    });
  }
  if (line.verb == "picture") {
    const int side = static_cast<int>(scriptChoice(name_, line, 1, {"a", "b"}));
    w.writePictureFile(line.words[0], side);
    gnomon::say(fmt::format("wrote {}\n", line.words[0]));
    return;
  }
  if (line.verb == "memory") {
    gnomon::say(fmt::format("memory {} {} MiB\n", line.words[0], processMemory().resident >> 20));
    return;
  }
  if (line.verb == "controls") {
    for (const Control& control : w.controls_)
      gnomon::say(fmt::format("{} = {}\n", control.name, control.get(w.state_)));
    return;
  }
  gnomon::say(w.statusCommand() + "\n");  // command
}

void ScriptPlayer::play(const ScriptLine& line) {
  ViewWindow& w = window_;
  const auto count = [&](size_t word, int least, int most) { return scriptCount(name_, line, word, least, most); };
  const std::string& verb = line.verb;
  const auto frames = [this](int left) { wait([left]() mutable { return left-- > 0; }); };
  if (verb == "set") {
    w.inputTime_ = ViewClock::now();
    w.setControl(line.words[0], line.words.size() > 1 ? line.words[1] : "");
    return frames(1);
  }
  if (verb == "expect") {
    const std::string wanted = line.words.size() > 1 ? line.words[1] : "", is = w.getControl(line.words[0]);
    if (is != wanted) fail(line, fmt::format("{} is '{}', not '{}'", line.words[0], is, wanted));
    return;
  }
  if (verb == "expect-problem") {
    const std::string wanted = line.words.empty() ? "" : line.words[0];
    const std::string is = !w.message_.empty() && w.messageIsProblem_ ? w.message_ : w.pictureProblem_;
    if (wanted.empty() ? !is.empty() : is.find(wanted) == std::string::npos)
      fail(line, fmt::format("the window's problem is '{}', not '{}'", is, wanted));
    w.message_.clear();
    return;
  }
  if (verb == "wait-frames") return frames(count(0, 1, kMostSteps));
  if (verb == "wait-refined")
    return wait([this] {
      window_.scriptWaits_ = !isRefined();
      return window_.scriptWaits_;
    });
  if (verb == "wait-ready")
    return wait([this] {
      window_.scriptWaits_ = !isRefined() || !window_.worker_->isReady();
      return window_.scriptWaits_;
    });
  if (verb == "animate") return animate(line);
  if (verb == "rest") return rest(count(0, 1, kMostSteps));
  if (verb == "turntable") return turntable(line);
  if (verb == "random")
    return random(count(0, 1, kMostSteps), line.words.size() > 1 ? static_cast<unsigned>(count(1, 0, kMostSteps)) : 1u);
  if (verb == "drop") {
    w.dropped_.push_back(line.words[0]);
    return frames(2);
  }
  if (verb == "save") return w.saveSession(line.words[0]);
  if (verb == "undo" || verb == "redo") {
    verb == "undo" ? w.undo() : w.redo();
    return frames(1);
  }
  if (verb == "resize") {
    const auto side = [&](size_t word) { return count(word, 64, 16384); };
    glfwSetWindowSize(w.window_, side(0), side(1));
    return frames(5);
  }
  if (verb == "minimise" || verb == "restore") {
    verb == "minimise" ? glfwIconifyWindow(w.window_) : glfwRestoreWindow(w.window_);
    return frames(3);
  }
  if (verb == "lose-device") return line.words.empty() ? w.worker_->loseDevice() : w.remakePresenter();
  if (verb == "quit") {
    w.quits_ = true;
    return;
  }
  const bool isOutput =
      verb == "screenshot" || verb == "picture" || verb == "controls" || verb == "command" || verb == "memory";
  isOutput ? playOutput(line) : playInput(line);
}

}  // namespace gnomon
