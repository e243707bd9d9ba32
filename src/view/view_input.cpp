// What is done to the picture by mouse and keys: camera, light, the split's edge.

#include "view/view_window.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

namespace {

constexpr float kHandle = 9.0f;        // pixels about a handle that take hold of it, at scale 1
constexpr double kTurnPerPixel = 0.3;  // degrees

glm::dvec3 turned(const glm::dvec3& v, double degrees, const glm::dvec3& axis) {
  return glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis) * glm::dvec4(v, 0.0));
}

}  // namespace

// What the camera turns round: what it sees in the middle of the picture.
glm::dvec3 ViewWindow::pivot() {
  if (pivot_) return *pivot_;
  const glsl::CameraView& camera = picture_->camera;
  const glm::dvec3 eye = eyeOf(camera), forward(camera.forwardW);
  const std::optional<SurfaceHit> hit = traced_->tracer.firstHit({.origin = eye, .dir = forward});
  const double toCenter = glm::dot(glm::dvec3(traced_->tracer.boundsW().center()) - eye, forward);
  const double usual = std::max(toCenter, 0.05 * static_cast<double>(traced_->tracer.boundsW().diagonal()));
  pivot_ = eye + forward * (hit ? hit->distance : usual);
  return *pivot_;
}

void ViewWindow::turnCamera(double degrees) {
  const Camera camera = chooseCamera(state_.setup, traced_->tracer);
  const glm::dvec3 center(traced_->tracer.boundsW().center());
  const glm::dvec3 eye(camera.worldFromEye[3]), forward(-camera.worldFromEye[2]);
  const double distance = std::max(glm::dot(center - eye, forward), 1e-3);
  const glm::dvec3 up(0, 1, 0);
  const glm::dvec3 newEye = center + turned(eye - center, degrees, up);
  placeCamera(state_, *traced_, newEye, newEye + turned(forward, degrees, up) * distance,
              glm::degrees(static_cast<double>(camera.yFovRad)));
}

void ViewWindow::turnLight(double degrees, double liftDegrees) {
  const Light light = lightOf(state_, *traced_);
  const glm::dvec3 center(traced_->tracer.boundsW().center());
  const glm::dvec3 up(0, 1, 0);
  glm::dvec3 away = light.type == LightType::Directional
                        ? -glm::dvec3(light.directionW) * static_cast<double>(traced_->tracer.boundsW().diagonal())
                        : glm::dvec3(light.positionW) - center;
  away = turned(away, degrees, up);
  const glm::dvec3 sideways = glm::cross(away, up);
  if (glm::length(sideways) > 1e-3 * glm::length(away)) {
    const glm::dvec3 lifted = turned(away, liftDegrees, glm::normalize(sideways));
    if (std::abs(glm::normalize(lifted).y) < 0.995) away = lifted;
  }
  moveLight(state_, *traced_, center + away);
}

// 0: turn round the pivot, 1: sideways, 2: nearer (dy), 3: fly (dx right, dy forward in metres).
void ViewWindow::navigate(float dx, float dy, int how) {
  const Camera chosen = chooseCamera(state_.setup, traced_->tracer);
  const glm::dvec3 right(chosen.worldFromEye[0]), upward(chosen.worldFromEye[1]), forward(-chosen.worldFromEye[2]);
  const double fov = glm::degrees(static_cast<double>(chosen.yFovRad));
  const glm::dvec3 middle = pivot();
  glm::dvec3 eye(chosen.worldFromEye[3]);
  glm::dvec3 away = eye - middle;
  const double distance = std::max(glm::length(away), 1e-6);
  const glm::dvec3 up(0, 1, 0);
  if (how == 0) {
    // About the pivot, which stays where it is in the picture.
    glm::dvec3 look = forward;
    away = turned(away, -kTurnPerPixel * static_cast<double>(dx), up);
    look = turned(look, -kTurnPerPixel * static_cast<double>(dx), up);
    const glm::dvec3 sideways = glm::cross(look, up);
    if (glm::length(sideways) > 1e-3) {
      const glm::dvec3 axis = glm::normalize(sideways);
      const double lift = -kTurnPerPixel * static_cast<double>(dy);
      if (const glm::dvec3 lifted = turned(look, lift, axis); std::abs(lifted.y) < 0.995) {
        look = lifted;
        away = turned(away, lift, axis);
      }
    }
    eye = middle + away;
    placeCamera(state_, *traced_, eye, eye + look * distance, fov);
    return;
  }
  glm::dvec3 move(0.0);
  if (how == 1) {
    const double metres = 2.0 * distance * std::tan(0.5 * glm::radians(fov)) / std::max(place_.rect.height, 1);
    move = -right * (static_cast<double>(dx) * metres) + upward * (static_cast<double>(dy) * metres);
    pivot_ = middle + move;
  } else if (how == 2) {
    move = forward * (distance * (1.0 - std::pow(0.9, static_cast<double>(dy))));
  } else {
    move = right * static_cast<double>(dx) + forward * static_cast<double>(dy);
    pivot_ = middle + move;
  }
  placeCamera(state_, *traced_, eye + move, eye + move + forward * distance, fov);
}

void ViewWindow::handleMouse() {
  ImGuiIO& io = ImGui::GetIO();
  if (!picture_ || !traced_ || place_.rect.width == 0) return;
  const glm::vec2 mouse(io.MousePos.x, io.MousePos.y);
  const bool released = !ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2);
  if (drag_ != Drag::None && released) {
    if (drag_ == Drag::Edge) rememberState();
    drag_ = Drag::None;
    lastChange_ = ViewClock::now() - std::chrono::seconds(1);  // at rest at once
  }
  const bool isMine = !io.WantCaptureMouse;
  guarded([&] {
    if (drag_ == Drag::None && isMine) {
      const Light light = lightOf(state_, *traced_);
      if (goesOn_ && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2)))
        rememberState();
      if (ImGui::IsMouseClicked(0)) {
        const float edge = static_cast<float>(place_.rect.x) + static_cast<float>(state_.splitAt * place_.rect.width);
        drag_ = Drag::Orbit;
        if (io.KeyCtrl) {
          drag_ = Drag::LightTurn;
        } else {
          const LightHandles handles = lightHandles(light);
          const bool isSun = light.type == LightType::Directional;
          const auto holds = [&](const std::optional<glm::vec2>& handle) {
            return handle && glm::distance(*handle, mouse) <= kHandle * scale_;
          };
          for (int axis = 0; axis < 3; ++axis) {
            if (!holds(handles.tips[axis])) continue;
            drag_ = isSun ? Drag::LightTurn : Drag::LightAxis;
            dragAxis_ = axis;
          }
          if (!isSun && holds(handles.middle)) drag_ = Drag::Light;
        }
        if (drag_ == Drag::Orbit && state_.split && std::abs(mouse.x - edge) <= kHandle * scale_) drag_ = Drag::Edge;
      } else if (ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2)) {
        drag_ = Drag::Pan;
      }
      if (drag_ == Drag::Orbit) pivot_.reset();
    }
    if (isMine && io.MouseWheel != 0.0f) {
      navigate(0.0f, io.MouseWheel, 2);
      noteChange(true);
    }
    const ImVec2 delta = io.MouseDelta;
    if (drag_ == Drag::None || (delta.x == 0.0f && delta.y == 0.0f)) return;
    if (drag_ == Drag::Edge) {
      state_.splitAt = std::clamp((static_cast<double>(mouse.x) - place_.rect.x) / place_.rect.width, 0.0, 1.0);
      framesPending_ = 2;
      return;  // the pictures are there
    }
    if (drag_ == Drag::Orbit) navigate(delta.x, delta.y, 0);
    if (drag_ == Drag::Pan) navigate(delta.x, delta.y, 1);
    if (drag_ == Drag::LightTurn) turnLight(0.5 * static_cast<double>(delta.x), 0.5 * static_cast<double>(delta.y));
    if (drag_ == Drag::Light || drag_ == Drag::LightAxis) {
      const Light light = lightOf(state_, *traced_);
      const glm::dvec3 at(light.positionW);
      const RayD before = rayAt(mouse.x - delta.x, mouse.y - delta.y), now = rayAt(mouse.x, mouse.y);
      if (drag_ == Drag::Light) {
        // In the plane through the light that faces the camera.
        const glm::dvec3 normal(picture_->camera.forwardW);
        const double depth = glm::dot(at - now.origin, normal);
        const glm::dvec3 move =
            now.dir * (depth / glm::dot(now.dir, normal)) - before.dir * (depth / glm::dot(before.dir, normal));
        moveLight(state_, *traced_, at + move);
      } else {
        // Along the axis: as far as its picture follows the mouse.
        const LightHandles handles = lightHandles(light);
        const auto a = handles.middle, b = handles.tips[dragAxis_];
        if (!a || !b) return;
        const glm::dvec2 along(*b - *a);
        const double squared = glm::dot(along, along);
        if (squared < 1.0) return;
        glm::dvec3 moved = at;
        moved[dragAxis_] += handles.metres * glm::dot(along, glm::dvec2(delta.x, delta.y)) / squared;
        moveLight(state_, *traced_, moved);
      }
    }
    noteChange(true);
  });
}

// Kept in its order until frames take it. ImGui's own callback of keys stays, for what is held when a frame begins.
void ViewWindow::listenToInput() {
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
    static_cast<ViewWindow*>(glfwGetWindowUserPointer(window))->input_.emplace_back(static_cast<char32_t>(character));
  });
  // As events have it: glfwGetCursorPos() knows where it is by now.
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    static_cast<ViewWindow*>(glfwGetWindowUserPointer(window))->pointer_ = {x, y};
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double steps) {
    static_cast<ViewWindow*>(glfwGetWindowUserPointer(window))
        ->input_.emplace_back(WheelTurn{static_cast<float>(steps)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int mods) {
    auto* self = static_cast<ViewWindow*>(glfwGetWindowUserPointer(window));
    if (button >= static_cast<int>(self->buttons_.size())) return;
    self->input_.emplace_back(ButtonTurn{.button = button,
                                         .isDown = action == GLFW_PRESS,
                                         .at = self->pointer_,
                                         .ctrl = (mods & GLFW_MOD_CONTROL) != 0,
                                         .shift = (mods & GLFW_MOD_SHIFT) != 0});
  });
}

// A mouse button or the wheel alone, or a key with the characters behind it: what follows waits for the next frame.
// Null where nothing waited: then what is held counts.
std::optional<KeyTap> ViewWindow::takeInput() {
  ImGuiIO& io = ImGui::GetIO();
  const int before = std::exchange(lastTapped_, 0);
  std::optional<KeyTap> taken;
  if (!input_.empty()) {
    taken.emplace();
    framesPending_ = std::max(framesPending_, 2);  // what it does, and that it ended
    const auto* turn = std::get_if<ButtonTurn>(&input_.front());
    const auto* key = std::get_if<KeyTap>(&input_.front());
    const glm::vec2 at = turn != nullptr ? turn->at : mouse_;
    io.MousePos = ImVec2(at.x, at.y);
    if (turn != nullptr && at == mouse_) {  // else there first, so that a drag has its way
      buttons_[static_cast<size_t>(turn->button)] = turn->isDown;
      *taken = {.ctrl = turn->ctrl, .shift = turn->shift};
      input_.pop_front();
    } else if (const auto* wheel = std::get_if<WheelTurn>(&input_.front())) {
      io.MouseWheel += wheel->steps;
      input_.pop_front();
    } else if (turn == nullptr && (key == nullptr || key->key != before)) {  // else let go between two taps
      if (key != nullptr) {
        *taken = *key;
        input_.pop_front();
      }
      for (; !input_.empty() && std::holds_alternative<char32_t>(input_.front()); input_.pop_front())
        io.AddInputCharacter(std::get<char32_t>(input_.front()));
    }
    for (const InputEvent& event : input_)
      if (const auto* later = std::get_if<KeyTap>(&event)) io.KeysDown[later->key] = false;
    if (taken->key != 0) io.KeysDown[taken->key] = true;
    lastTapped_ = taken->key;
  }
  mouse_ = {io.MousePos.x, io.MousePos.y};
  std::ranges::copy(buttons_, io.MouseDown);
  return taken;
}

// What was pressed before comes before: of a tap, and not of what is held by now.
void ViewWindow::handleKeys(const KeyTap& tap) {
  ImGuiIO& io = ImGui::GetIO();
  const auto pressed = [&](int key) { return tap.key == key; };
  if (tap.key != 0 && goesOn_) rememberState();  // what went on until now is a step of its own
  // Keyboards have the character in different places.
  const bool asksForHelp = pressed(GLFW_KEY_F1) || io.InputQueueCharacters.contains('?');
  if (asksForHelp) showKeys_ = !showKeys_;
  if (pressed(GLFW_KEY_ESCAPE)) {
    showKeys_ = false;
    drag_ = Drag::None;
    message_.clear();
  }
  guarded([&] {
    if (tap.ctrl) {
      if (pressed(GLFW_KEY_Z)) tap.shift ? redo() : undo();
      if (pressed(GLFW_KEY_Y)) redo();
      if (pressed(GLFW_KEY_S)) saveSession(options_.session.empty() ? "gnomon-view.json" : options_.session);
      if (pressed(GLFW_KEY_Q)) quits_ = true;
      return;
    }
    const auto toggle = [&](const char* name) { setControl(name, getControl(name) == "on" ? "off" : "on"); };
    if (pressed(GLFW_KEY_TAB)) toggle("split");
    if (pressed(GLFW_KEY_L)) toggle("loupe");
    if (pressed(GLFW_KEY_M)) toggle("unfolded");
    if (pressed(GLFW_KEY_F)) toggle("fog");
    if (pressed(GLFW_KEY_G)) showTimes_ = !showTimes_;
    if (pressed(GLFW_KEY_H)) showPanel_ = !showPanel_;
    if (pressed(GLFW_KEY_C)) copyCommand(tap.shift);
    if (pressed(GLFW_KEY_X)) {
      std::swap(state_.sides[0], state_.sides[1]);
      noteChange(false);
    }
    const std::string side = tap.shift ? "b." : "a.";
    constexpr std::array kShows = {"beauty", "visibility", "truth", "difference", "labels"};
    for (size_t i = 0; i < kShows.size(); ++i)
      if (pressed(GLFW_KEY_1 + static_cast<int>(i))) setControl(side + "show", kShows[i]);
    if (pressed(GLFW_KEY_COMMA) || pressed(GLFW_KEY_PERIOD)) {
      const Control& bias = findControl(controls_, side + "bias");
      const auto& names = bias.choices;
      const auto at = std::ranges::find(names, bias.get(state_));
      const size_t count = names.size();
      const size_t now = at == names.end() ? 0 : static_cast<size_t>(at - names.begin());
      setControl(bias.name, names[(now + (pressed(GLFW_KEY_PERIOD) ? 1 : count - 1)) % count]);
    }
    if (pressed(GLFW_KEY_LEFT_BRACKET) || pressed(GLFW_KEY_RIGHT_BRACKET)) {
      const int side0 = state_.sides[0].options.mapSide;
      const int next = pressed(GLFW_KEY_RIGHT_BRACKET) ? side0 * 2 : side0 / 2;
      setControl("a.map-size", fmt::format("{}", next));
      if (state_.split) setControl("b.map-size", fmt::format("{}", next));
    }
    if (pressed(GLFW_KEY_HOME)) {
      state_.setup.camera.clear();
      pivot_.reset();
      noteChange(false);
    }
    if (pressed(GLFW_KEY_P)) {
      if (tap.shift)
        keepFrame_ = redrawKept_ = true;  // this very frame, without the message
      else
        writePictureFile(freeName("gnomon-view"), 0);
    }
    if (pressed(GLFW_KEY_T) && !script_)
      script_ = std::make_unique<ScriptPlayer>(*this, "turntable",
                                               parseScript("turntable", "turntable turntable 48 camera\n"));
    if (!traced_ || !picture_ || io.KeyCtrl) return;
    float right = 0.0f, forward = 0.0f, upward = 0.0f;
    const auto held = [&](int key) { return ImGui::IsKeyDown(key) && !pressedWithModifier_.contains(key); };
    const float metres = 0.15f * traced_->tracer.boundsW().diagonal() * frameSeconds_ * (io.KeyShift ? 4.0f : 1.0f);
    if (held(GLFW_KEY_W)) forward += metres;
    if (held(GLFW_KEY_S)) forward -= metres;
    if (held(GLFW_KEY_D)) right += metres;
    if (held(GLFW_KEY_A)) right -= metres;
    if (held(GLFW_KEY_E)) upward += metres;
    if (held(GLFW_KEY_Q)) upward -= metres;
    if (right != 0.0f || forward != 0.0f) {
      navigate(right, forward, 3);
      noteChange(true);
    }
    if (upward != 0.0f) {
      const float pixels = upward * static_cast<float>(place_.rect.height) /
                           std::max(2.0f * static_cast<float>(glm::length(eyeOf(picture_->camera) - pivot())) *
                                        picture_->camera.tanHalfY,
                                    1e-6f);
      navigate(0.0f, pixels, 1);
      noteChange(true);
    }
  });
}

}  // namespace gnomon
