// The picture and what is drawn above it and done to it: camera, light, split, loupe, unfolded map.

#include "view/view_window.h"

#include "base/error.h"
#include "base/parse.h"
#include "lab/picture/pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

namespace gnomon {

namespace {

// Okabe and Ito.
constexpr ImU32 kSky = IM_COL32(86, 180, 233, 255), kGreen = IM_COL32(0, 158, 115, 255),
                kYellow = IM_COL32(240, 228, 66, 255), kVermillion = IM_COL32(213, 94, 0, 255),
                kWhite = IM_COL32(255, 255, 255, 255), kBlack = IM_COL32(0, 0, 0, 255);
constexpr ImU32 kAxes[3] = {kVermillion, kGreen, kSky};

constexpr int kLoupePixels = 13;     // a side
constexpr float kLoupeZoom = 12.0f;  // at scale 1
constexpr float kUnfoldedShare = 0.42f;

void ringed(ImDrawList& list, ImVec2 at, float radius, ImU32 color) {
  list.AddCircle(at, radius, kBlack, 0, 4.0f);
  list.AddCircle(at, radius, color, 0, 2.0f);
}

void outlined(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color) {
  list.AddLine(from, to, kBlack, 4.0f);
  list.AddLine(from, to, color, 2.0f);
}

// To be read on white, too.
void outlinedText(ImDrawList& list, ImVec2 at, const char* text) {
  for (const auto& [dx, dy] : {std::pair{-1.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, -1.0f}, {0.0f, 1.0f}})
    list.AddText(ImVec2(at.x + dx, at.y + dy), kBlack, text);
  list.AddText(at, kWhite, text);
}

}  // namespace

// ---- layout ----

void ViewWindow::layOut() {
  const ImGuiIO& io = ImGui::GetIO();
  const auto width = static_cast<int>(io.DisplaySize.x), height = static_cast<int>(io.DisplaySize.y);
  const int status = static_cast<int>(statusHeight());
  panelWidth_ = showPanel_ ? std::min(330.0f * scale_, 0.45f * io.DisplaySize.x) : 0.0f;
  const int left = static_cast<int>(panelWidth_);
  canvas_ = {left, 0, std::max(width - left, 1), std::max(height - status, 1)};
  unfoldedRect_ = {};
  unfoldedRoom_ = 0;
  int pictureHeight = canvas_.height;
  if (state_.unfolded && !state_.fog.on) {
    const int most = static_cast<int>(kUnfoldedShare * static_cast<float>(canvas_.height));
    unfoldedRect_ = {canvas_.x, canvas_.y + canvas_.height - most, canvas_.width, most};
    unfoldedRoom_ = most;
    pictureHeight -= most;
    if (unfoldedWidth_ > 0) {
      const double scale =
          std::min(static_cast<double>(canvas_.width) / unfoldedWidth_, static_cast<double>(most) / unfoldedHeight_);
      unfoldedRect_.width = std::max(static_cast<int>(scale * unfoldedWidth_), 1);
      unfoldedRect_.x = canvas_.x + (canvas_.width - unfoldedRect_.width) / 2;
      const int tall = std::max(static_cast<int>(scale * unfoldedHeight_), 1);
      unfoldedRect_.y += most - tall;
      unfoldedRect_.height = tall;
    }
  }
  place_ = {};
  if (!picture_ || picture_->fullWidth == 0) return;
  place_.fullWidth = picture_->fullWidth;
  place_.fullHeight = picture_->fullHeight;
  double scale = std::min(static_cast<double>(canvas_.width) / place_.fullWidth,
                          static_cast<double>(pictureHeight) / place_.fullHeight);
  if (scale > 1.0) scale = std::floor(scale);
  place_.scale = static_cast<float>(scale);
  place_.rect.width = std::max(static_cast<int>(scale * place_.fullWidth), 1);
  place_.rect.height = std::max(static_cast<int>(scale * place_.fullHeight), 1);
  place_.rect.x = canvas_.x + (canvas_.width - place_.rect.width) / 2;
  place_.rect.y = canvas_.y + (pictureHeight - place_.rect.height) / 2;
}

int ViewWindow::sideAt(float x) const {
  if (!state_.split || !picture_ || picture_->sides[1].image.values.empty()) return 0;
  return x - static_cast<float>(place_.rect.x) < static_cast<float>(state_.splitAt * place_.rect.width) ? 0 : 1;
}

glm::ivec2 ViewWindow::pixelAt(float x, float y) const {
  if (!picture_ || place_.rect.width == 0) return {-1, -1};
  return {static_cast<int>(std::floor((x - static_cast<float>(place_.rect.x)) * static_cast<float>(picture_->width) /
                                      static_cast<float>(place_.rect.width))),
          static_cast<int>(std::floor((y - static_cast<float>(place_.rect.y)) * static_cast<float>(picture_->height) /
                                      static_cast<float>(place_.rect.height)))};
}

std::optional<glm::vec2> ViewWindow::project(const glm::dvec3& pointW) const {
  if (!picture_ || place_.rect.width == 0) return std::nullopt;
  const glm::dvec4 clip = glm::dmat4(picture_->camera.clipFromWorld) * glm::dvec4(pointW, 1.0);
  const glm::dvec3 away = pointW - eyeOf(picture_->camera);
  if (glm::dot(away, glm::dvec3(picture_->camera.forwardW)) <= 0.0) return std::nullopt;
  const double x = 0.5 + 0.5 * clip.x / clip.w;
  const double depthless = glm::dot(away, glm::dvec3(picture_->camera.upW)) /
                           glm::dot(away, glm::dvec3(picture_->camera.forwardW)) /
                           static_cast<double>(picture_->camera.tanHalfY);
  const double y = 0.5 - 0.5 * depthless;
  return glm::vec2(static_cast<float>(place_.rect.x + x * place_.rect.width),
                   static_cast<float>(place_.rect.y + y * place_.rect.height));
}

RayD ViewWindow::rayAt(float x, float y) const {
  const glsl::CameraView& camera = picture_->camera;
  const double sx =
      (2.0 * (static_cast<double>(x) - place_.rect.x) / place_.rect.width - 1.0) * static_cast<double>(camera.tanHalfX);
  const double sy = (1.0 - 2.0 * (static_cast<double>(y) - place_.rect.y) / place_.rect.height) *
                    static_cast<double>(camera.tanHalfY);
  return {.origin = eyeOf(camera),
          .dir = glm::normalize(glm::dvec3(camera.forwardW) + glm::dvec3(camera.rightW) * sx +
                                glm::dvec3(camera.upW) * sy)};
}

ViewWindow::LightHandles ViewWindow::lightHandles(const Light& light) const {
  LightHandles handles;
  if (light.type == LightType::Directional) {
    const glm::dvec3 middle(traced_->tracer.boundsW().center());
    handles.metres = 0.15 * static_cast<double>(traced_->tracer.boundsW().diagonal());
    handles.middle = project(middle);
    handles.tips[0] = project(middle - glm::dvec3(light.directionW) * handles.metres);
    return handles;
  }
  const glm::dvec3 at(light.positionW);
  handles.metres = 0.12 * glm::length(at - eyeOf(picture_->camera));
  handles.middle = project(at);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 tip = at;
    tip[axis] += handles.metres;
    handles.tips[axis] = project(tip);
  }
  return handles;
}

// ---- what is drawn above ----

void ViewWindow::drawCanvas() {
  if (!picture_ || place_.rect.width == 0) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddText(ImVec2(static_cast<float>(canvas_.x) + 16.0f, static_cast<float>(canvas_.y) + 40.0f), kWhite,
                 fmt::format("opening {} ...", state_.setup.scene).c_str());
    return;
  }
  drawLegend();
  drawSplitEdge();
  if (traced_) guarded([&] { drawGizmo(); });
  if (state_.loupe) drawLoupe();
  drawUnfoldedCursor();
}

void ViewWindow::drawSplitEdge() {
  if (!state_.split) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float x = static_cast<float>(place_.rect.x) + static_cast<float>(state_.splitAt * place_.rect.width);
  const auto top = static_cast<float>(place_.rect.y), bottom = top + static_cast<float>(place_.rect.height);
  outlined(list, ImVec2(x, top), ImVec2(x, bottom), kWhite);
  const auto label = [&](int side) {
    const ViewSide& shown = state_.sides[static_cast<size_t>(side)];
    return state_.fog.on ? fmt::format("{} {}", "AB"[side], shown.integrator)
                         : fmt::format("{} {} {}: {}", "AB"[side], shown.options.maps.front()->name(),
                                       shown.options.biases.front()->name, shown.show);
  };
  const auto boxed = [&](const std::string& text, float right, float left) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float at = right > 0.0f ? right - size.x : left;
    list.AddRectFilled(ImVec2(at - 3.0f, bottom - size.y - 7.0f), ImVec2(at + size.x + 3.0f, bottom - 3.0f),
                       IM_COL32(0, 0, 0, 170));
    list.AddText(ImVec2(at, bottom - size.y - 5.0f), kWhite, text.c_str());
  };
  boxed(label(0), x - 8.0f, 0.0f);
  boxed(label(1), 0.0f, x + 8.0f);
}

// What the colours of labels and of differences mean.
void ViewWindow::drawLegend() {
  if (state_.fog.on) return;
  const auto shows = [&](const char* what) {
    return state_.sides[0].show == what || (state_.split && state_.sides[1].show == what);
  };
  struct Entry {
    glm::u8vec3 color;
    std::string text;
  };
  std::vector<Entry> entries;
  if (shows("labels")) {
    for (const Label label : {Label::Acne, Label::Leak, Label::EdgeShadow, Label::EdgeLight, Label::Uncovered})
      entries.push_back({labelColor(label), labelName(label)});
    const auto names = [](const SidePicture& side) { return side.judged && side.judged->labels.unseen; };
    if (std::ranges::any_of(picture_->sides, names)) entries.push_back({kUnseenColor, "unseen occluder"});
  } else if (shows("difference")) {
    entries = {{labelColor(Label::Leak), "too light"}, {labelColor(Label::Acne), "too dark"}};
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float left = static_cast<float>(place_.rect.x) + 8.0f, size = ImGui::GetFontSize();
  const auto right = static_cast<float>(place_.rect.x + place_.rect.width);
  float x = left, y = static_cast<float>(place_.rect.y) + 8.0f;
  for (const Entry& entry : entries) {
    const float width = ImGui::CalcTextSize(entry.text.c_str()).x + size + 14.0f;
    if (x > left && x + width > right) {
      x = left;
      y += size + 8.0f;
    }
    list.AddRectFilled(ImVec2(x - 4.0f, y - 4.0f), ImVec2(x + width - 4.0f, y + size + 4.0f), IM_COL32(0, 0, 0, 170));
    list.AddRectFilled(ImVec2(x, y), ImVec2(x + size, y + size),
                       IM_COL32(entry.color[0], entry.color[1], entry.color[2], 255));
    list.AddText(ImVec2(x + size + 4.0f, y), kWhite, entry.text.c_str());
    x += width;
  }
}

void ViewWindow::drawGizmo() {
  const Light light = lightOf(state_, *traced_);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 from(static_cast<float>(canvas_.x), static_cast<float>(canvas_.y));
  list.PushClipRect(from,
                    ImVec2(from.x + static_cast<float>(canvas_.width), from.y + static_cast<float>(canvas_.height)));
  const LightHandles handles = lightHandles(light);
  if (handles.middle) {
    const ImVec2 middle(handles.middle->x, handles.middle->y);
    for (int axis = 0; axis < 3; ++axis) {
      if (!handles.tips[axis]) continue;
      const ImVec2 end(handles.tips[axis]->x, handles.tips[axis]->y);
      if (light.type == LightType::Directional) {
        // An arrow through what the camera looks at, the way the light travels.
        outlined(list, end, middle, kYellow);
        ringed(list, end, 6.0f * scale_, kYellow);
        continue;
      }
      outlined(list, middle, end, kAxes[axis]);
      list.AddCircleFilled(end, 4.0f * scale_, kAxes[axis]);
      const char name[2] = {"xyz"[axis], '\0'};
      outlinedText(list, ImVec2(end.x + 5.0f, end.y - 6.0f), name);
    }
    if (light.type != LightType::Directional) ringed(list, middle, 7.0f * scale_, kYellow);
  }
  list.PopClipRect();
}

void ViewWindow::drawLoupe() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse && !scripted_.drives) return;
  const glm::ivec2 center = pixelAt(io.MousePos.x, io.MousePos.y);
  if (center.x < 0 || center.y < 0 || center.x >= picture_->width || center.y >= picture_->height) return;
  const int side = sideAt(io.MousePos.x);
  const SidePicture& drawn = picture_->sides[static_cast<size_t>(side)];
  if (drawn.image.values.empty() || !isOfCamera(side)) return;
  const std::vector<std::string> facts = state_.fog.on
                                             ? std::vector<std::string>{fmt::format("pixel {}, {}", center.x, center.y)}
                                             : pixelFacts(*picture_, side, center);
  const float cell = std::round(kLoupeZoom * scale_), width = cell * kLoupePixels;
  const float wrap = 30.0f * ImGui::GetFontSize();
  float textWidth = 0.0f, textHeight = 0.0f;
  for (const std::string& fact : facts) {
    const ImVec2 size = ImGui::CalcTextSize(fact.c_str(), nullptr, false, wrap);
    textWidth = std::max(textWidth, size.x);
    textHeight += size.y;
  }
  const float boxWidth = width + textWidth + 24.0f, boxHeight = std::max(width, textHeight) + 16.0f;
  // Beside the cursor, within the canvas.
  ImVec2 at(io.MousePos.x + 24.0f, io.MousePos.y + 24.0f);
  const auto right = static_cast<float>(canvas_.x + canvas_.width),
             bottom = static_cast<float>(canvas_.y + canvas_.height);
  if (at.x + boxWidth > right) at.x = std::max(io.MousePos.x - 24.0f - boxWidth, static_cast<float>(canvas_.x));
  if (at.y + boxHeight > bottom) at.y = std::max(io.MousePos.y - 24.0f - boxHeight, static_cast<float>(canvas_.y));
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled(at, ImVec2(at.x + boxWidth, at.y + boxHeight), IM_COL32(20, 20, 22, 240));
  list.AddRect(at, ImVec2(at.x + boxWidth, at.y + boxHeight), kWhite);
  const ImVec2 origin(at.x + 8.0f, at.y + 8.0f);
  const int half = kLoupePixels / 2;
  const auto corner = [&](int dx, int dy) {
    return ImVec2(origin.x + cell * static_cast<float>(dx + half), origin.y + cell * static_cast<float>(dy + half));
  };
  const auto forEachPixel = [&](const auto& draw) {
    for (int dy = -half; dy <= half; ++dy) {
      for (int dx = -half; dx <= half; ++dx) {
        const int x = center.x + dx, y = center.y + dy;
        if (x >= 0 && y >= 0 && x < picture_->width && y < picture_->height) draw(dx, dy, x, y);
      }
    }
  };
  forEachPixel([&](int dx, int dy, int x, int y) {
    const uint8_t* rgb = drawn.image.at(x, y);
    const ImVec2 from = corner(dx, dy);
    list.AddRectFilled(from, ImVec2(from.x + cell, from.y + cell), IM_COL32(rgb[0], rgb[1], rgb[2], 255));
  });
  // Where the next pixel is decided by another texel; white and black, so that a line is seen on anything.
  forEachPixel([&](int dx, int dy, int x, int y) {
    const auto own = texelOf(*picture_, side, {x, y});
    if (!own) return;
    const auto differs = [&](int otherX, int otherY) {
      const auto other = texelOf(*picture_, side, {otherX, otherY});
      return other && (other->slice != own->slice || other->texel != own->texel);
    };
    const auto line = [&](const ImVec2& from, const ImVec2& to, float acrossX, float acrossY) {
      list.AddLine(from, to, kWhite);
      list.AddLine(ImVec2(from.x + acrossX, from.y + acrossY), ImVec2(to.x + acrossX, to.y + acrossY), kBlack);
    };
    const ImVec2 from = corner(dx, dy), to = corner(dx + 1, dy + 1);
    if (dx < half && differs(x + 1, y)) line(ImVec2(to.x, from.y), to, 1.0f, 0.0f);
    if (dy < half && differs(x, y + 1)) line(ImVec2(from.x, to.y), to, 0.0f, 1.0f);
  });
  const ImVec2 middle = corner(0, 0);
  list.AddRect(ImVec2(middle.x - 1.0f, middle.y - 1.0f), ImVec2(middle.x + cell + 1.0f, middle.y + cell + 1.0f), kBlack,
               0.0f, 0, 4.0f);
  list.AddRect(ImVec2(middle.x - 1.0f, middle.y - 1.0f), ImVec2(middle.x + cell + 1.0f, middle.y + cell + 1.0f),
               kYellow, 0.0f, 0, 2.0f);
  float y = origin.y;
  for (const std::string& fact : facts) {
    list.AddText(nullptr, 0.0f, ImVec2(origin.x + width + 8.0f, y), kWhite, fact.c_str(), nullptr, wrap);
    y += ImGui::CalcTextSize(fact.c_str(), nullptr, false, wrap).y;
  }
}

// From a pixel to its texel in the unfolded map, and from a texel there to its pixels.
void ViewWindow::drawUnfoldedCursor() {
  if (!state_.unfolded || state_.fog.on || unfoldedRect_.width == 0 || !picture_) return;
  const SidePicture& drawn = picture_->sides[0];
  if (drawn.unfolded.values.empty() || !drawn.fitted || drawn.diagnosis.empty()) return;
  const ImGuiIO& io = ImGui::GetIO();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float scaleX = static_cast<float>(unfoldedRect_.width) / static_cast<float>(drawn.unfolded.width);
  const float scaleY = static_cast<float>(unfoldedRect_.height) / static_cast<float>(drawn.unfolded.height);
  const auto mark = [&](const TexelPlace& texel) {
    const glm::ivec2 at = placeInUnfolded(*drawn.fitted, texel);
    const ImVec2 point(static_cast<float>(unfoldedRect_.x) + (static_cast<float>(at.x) + 0.5f) * scaleX,
                       static_cast<float>(unfoldedRect_.y) + (static_cast<float>(at.y) + 0.5f) * scaleY);
    ringed(list, point, 6.0f * scale_, kYellow);
    list.AddCircleFilled(point, 1.5f * scale_, kYellow);
  };
  if (const auto texel = texelOf(*picture_, 0, pixelAt(io.MousePos.x, io.MousePos.y))) mark(*texel);
  const glm::ivec2 within(static_cast<int>(std::floor((io.MousePos.x - static_cast<float>(unfoldedRect_.x)) / scaleX)),
                          static_cast<int>(std::floor((io.MousePos.y - static_cast<float>(unfoldedRect_.y)) / scaleY)));
  if (within.x >= drawn.unfolded.width || within.y >= drawn.unfolded.height) return;
  const std::optional<TexelPlace> texel = texelAtUnfolded(*drawn.fitted, within);
  if (!texel) return;
  mark(*texel);
  // A texel of the picture is smaller than a pixel of it here: those around it, too.
  const int reach = std::max(static_cast<int>(1.0f / std::max(scaleX, 1e-3f)), 0);
  const float pixel = static_cast<float>(place_.rect.width) / static_cast<float>(picture_->width);
  int drawnPixels = 0;
  for (int y = 0; y < picture_->height && drawnPixels < 5000; ++y) {
    for (int x = 0; x < picture_->width; ++x) {
      const auto own = texelOf(*picture_, 0, {x, y});
      if (!own || own->slice != texel->slice || std::abs(own->texel.x - texel->texel.x) > reach ||
          std::abs(own->texel.y - texel->texel.y) > reach)
        continue;
      const ImVec2 at(static_cast<float>(place_.rect.x) + static_cast<float>(x) * pixel,
                      static_cast<float>(place_.rect.y) + static_cast<float>(y) * pixel);
      list.AddRectFilled(at, ImVec2(at.x + std::max(pixel, 1.0f), at.y + std::max(pixel, 1.0f)), kYellow);
      ++drawnPixels;
    }
  }
}

}  // namespace gnomon
