// The controls at the left, the status line, the graph of stage times, the key list.

#include "view/view_window.h"

#include "base/error.h"
#include "base/parse.h"
#include "lab/fog/fog_pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace gnomon {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings;

// Okabe and Ito: told apart by all, as in the pictures.
const ImVec4 kProblem(0.90f, 0.62f, 0.0f, 1.0f);
const ImVec4 kQuiet(0.65f, 0.65f, 0.68f, 1.0f);

struct KeyHelp {
  const char* keys;
  const char* does;
};
constexpr KeyHelp kKeyHelp[] = {
    {"drag", "turn the camera round what it looks at"},
    {"right or middle drag", "move it sideways"},
    {"wheel", "nearer, farther"},
    {"W A S D, Q E", "fly; Shift: faster"},
    {"drag the lamp, its axes", "move the light; Ctrl+drag anywhere: turn it round the scene's centre"},
    {"Home", "the scene's own camera"},
    {"Tab", "split A | B; its edge is dragged"},
    {"1 2 3 4 5", "show beauty, visibility, truth, difference, labels in A; Shift: in B"},
    {"X", "swap A and B"},
    {", .", "the bias before, the next; Shift: of B"},
    {"[ ]", "half, double the map"},
    {"L", "loupe: a pixel, its texel, and why"},
    {"M", "unfolded map"},
    {"F", "fog"},
    {"C", "copy the command line of this picture; Shift+C: that of `gnomon compare`"},
    {"Ctrl+Z, Ctrl+Y", "undo, redo"},
    {"Ctrl+S", "save the session (gnomon-view.json, or --session); a session is opened by dropping it"},
    {"P", "write the picture; Shift+P: the window"},
    {"T", "write a turntable of the camera: frames, and a video where ffmpeg is"},
    {"G", "times of stages"},
    {"H", "hide the controls"},
    {"Esc", "end of what goes on; Ctrl+Q: end"},
    {"? or F1", "this list"}};

void tooltip(const Control& control, const std::string& value) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 36.0f);
  ImGui::TextUnformatted(
      fmt::format("{}{}", control.name, control.unit.empty() ? "" : " [" + control.unit + "]").c_str());
  ImGui::TextUnformatted(control.sentence.c_str());
  if (!value.empty() && control.kind == Control::Kind::Text) ImGui::TextUnformatted(value.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

// Where a line of text has to end, pixels; all of it where it fits.
size_t fitting(const std::string& text, float width) {
  const ImFont& font = *ImGui::GetFont();
  const char* begin = text.c_str();
  return static_cast<size_t>(
      font.CalcWordWrapPositionA(ImGui::GetFontSize() / font.FontSize, begin, begin + text.size(), width) - begin);
}

std::string shortened(const std::string& text, float width) {
  const size_t end = fitting(text, width);
  return end == text.size() ? text : text.substr(0, fitting(text, width - ImGui::CalcTextSize(" ...").x)) + " ...";
}

// Two lines: one command on both, or two on one each.
std::vector<std::string> statusLines(const std::vector<std::string>& commands, float width) {
  if (commands.size() == 2) return {shortened(commands[0], width), shortened(commands[1], width)};
  const std::string& command = commands.front();
  const size_t end = fitting(command, width);
  if (end == command.size()) return {command};
  return {command.substr(0, end), shortened(command.substr(command.find_first_not_of(' ', end)), width)};
}

}  // namespace

// A slider, dragged or typed into. What is typed is set by Enter, or when something else is clicked, and by Escape not
// at all.
void ViewWindow::drawNumber(const Control& control) {
  const std::string text = control.get(state_);
  std::string now = text;
  const std::optional<double> given = parseNumber(text);
  auto value = static_cast<float>(given.value_or(control.slideLower));
  const auto lower = static_cast<float>(control.slideLower), upper = static_cast<float>(control.slideUpper);
  const std::string id = control.label + "##" + control.name;
  bool edited = false;
  if (control.kind == Control::Kind::Whole) {
    int whole = static_cast<int>(std::lround(value));
    edited = ImGui::SliderInt(id.c_str(), &whole, static_cast<int>(lower), static_cast<int>(upper), "%d",
                              control.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    now = fmt::format("{}", whole);
  } else {
    const std::string format = given ? std::string("%.4g") : std::string("(its own)");
    edited = ImGui::SliderFloat(id.c_str(), &value, lower, upper, format.c_str(),
                                control.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    now = fmt::format("{}", value);
  }
  const ImGuiIO& io = ImGui::GetIO();
  const bool wasTyped = typed_.control == control.name && typed_.frame + 1 == framesDrawn_;
  if (ImGui::IsItemActive() && io.WantTextInput) {
    if (edited || wasTyped) typed_ = {.control = control.name, .value = edited ? now : text, .frame = framesDrawn_};
    return;
  }
  if (!edited && wasTyped &&
      !ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {  // another took the focus before this one was drawn
    now = typed_.value;
    edited = true;
  }
  if (!edited) return;
  inputTime_ = lastFrame_;
  guarded([&] {
    control.set(state_, now);
    noteChange(ImGui::IsMouseDown(0) && !wasTyped);
  });
}

void ViewWindow::drawControl(const Control& control) {
  const std::string text = control.get(state_);
  const std::string id = control.label + "##" + control.name;
  const auto apply = [&](const std::string& value) {
    guarded([&] {
      ViewState changed = state_;
      control.set(changed, value);
      state_ = changed;
      noteChange(false);
    });
  };
  switch (control.kind) {
    case Control::Kind::Toggle: {
      bool on = text == "on";
      if (ImGui::Checkbox(id.c_str(), &on)) apply(on ? "on" : "off");
      break;
    }
    case Control::Kind::Choice:
      if (ImGui::BeginCombo(id.c_str(), text.c_str())) {
        for (const std::string& choice : control.choices)
          if (ImGui::Selectable(choice.c_str(), choice == text)) apply(choice);
        ImGui::EndCombo();
      }
      break;
    case Control::Kind::Number:
    case Control::Kind::Whole:
      drawNumber(control);
      break;
    case Control::Kind::Text: {
      std::array<char, 1024> buffer{};
      std::copy_n(text.begin(), std::min(text.size(), buffer.size() - 1), buffer.begin());
      const bool hasList = !control.choices.empty();
      const float full = ImGui::CalcItemWidth();
      if (hasList) ImGui::SetNextItemWidth(full - ImGui::GetFrameHeight() - 2.0f);
      if (ImGui::InputTextWithHint(("##" + control.name).c_str(), "(its own)", buffer.data(), buffer.size(),
                                   ImGuiInputTextFlags_EnterReturnsTrue))
        apply(buffer.data());
      tooltip(control, text);
      if (hasList) {
        ImGui::SameLine(0.0f, 2.0f);
        if (ImGui::BeginCombo(("##list" + control.name).c_str(), "", ImGuiComboFlags_NoPreview)) {
          for (const std::string& choice : control.choices)
            if (ImGui::Selectable(choice.c_str(), choice == text)) apply(choice);
          ImGui::EndCombo();
        }
      }
      ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
      ImGui::TextUnformatted(control.label.c_str());
      break;
    }
  }
  tooltip(control, text);
}

void ViewWindow::drawControls() {
  std::string group;
  bool open = false;
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - 8.0f * ImGui::GetFontSize());
  for (const Control& control : controls_) {
    if (control.group != group) {
      group = control.group;
      const bool isB = group == "B", isFog = group == "Fog";
      if (isB && !state_.split) {
        open = false;
      } else {
        std::string title = group;
        if (group == "A" || group == "B") {
          const ViewSide& side = state_.sides[isB ? 1 : 0];
          title = state_.fog.on ? fmt::format("{}: {}", group, side.integrator)
                                : fmt::format("{}: {} {}", group, side.options.maps.front()->name(),
                                              side.options.biases.front()->name);
        }
        const bool shows = group != "Scene" && group != "Camera" && !isFog;
        open = ImGui::CollapsingHeader((title + "###" + group).c_str(),
                                       shows || (isFog && state_.fog.on) ? ImGuiTreeNodeFlags_DefaultOpen : 0);
      }
    }
    if (open && control.applies(state_)) drawControl(control);
  }
  ImGui::PopItemWidth();
}

// A side whose picture fog does not have.
void ViewWindow::drawFogNotes() {
  const std::vector<std::string> known = fogPicturesToShow();
  for (size_t side = 0; side < (state_.split ? 2u : 1u); ++side)
    if (const std::string& show = state_.sides[side].show; std::ranges::find(known, show) == known.end())
      ImGui::TextColored(kQuiet, "%c: fog has no %s; beauty is shown", "AB"[side], show.c_str());
}

void ViewWindow::drawCounts() {
  if (!picture_ || !pictureProblem_.empty()) return;
  ImGui::Separator();
  if (state_.fog.on) return drawFogNotes();
  for (size_t side = 0; side < (state_.split ? 2u : 1u); ++side) {
    const SidePicture& drawn = picture_->sides[side];
    if (drawn.bias == nullptr) continue;
    ImGui::PushTextWrapPos(0.0f);
    if (drawn.counts)
      ImGui::TextUnformatted(fmt::format("{}: {}", "AB"[side], countsLine(*drawn.counts)).c_str());
    else
      ImGui::TextColored(kQuiet, "%c: counted when at rest", "AB"[side]);
    ImGui::PopTextWrapPos();
  }
}

void ViewWindow::drawTimes() {
  if (!showTimes_) return;
  const float width = 30.0f * ImGui::GetFontSize();
  ImGui::SetNextWindowPos(
      ImVec2(static_cast<float>(canvas_.x + canvas_.width) - width - 8.0f, static_cast<float>(canvas_.y) + 8.0f));
  ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
  ImGui::Begin("times", nullptr, kFixed | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextUnformatted("wall clock of a picture's stages, ms: newest, median");
  for (const StageHistory& stage : times_) {
    if (stage.ms.empty()) continue;
    const std::vector<float> values(stage.ms.begin(), stage.ms.end());
    const std::string label = fmt::format("{:<10} {:6.1f} {:6.1f}", stage.name, values.back(), stage.median());
    ImGui::PlotLines(("##" + stage.name).c_str(), values.data(), static_cast<int>(values.size()), 0, nullptr, 0.0f,
                     std::max(2.0f * static_cast<float>(stage.median()), 1.0f), ImVec2(0.4f * width, 0.0f));
    ImGui::SameLine();
    ImGui::TextUnformatted(label.c_str());
  }
  if (picture_)
    ImGui::TextUnformatted(fmt::format("drawn {} x {} of {} x {}; budget {:g} ms", picture_->width, picture_->height,
                                       picture_->fullWidth, picture_->fullHeight, state_.budgetMs)
                               .c_str());
  if (!latencies_.empty()) ImGui::TextUnformatted(fmt::format("input to picture {:.0f} ms", latencies_.back()).c_str());
  ImGui::End();
}

float ViewWindow::statusHeight() {
  return 2.0f * ImGui::GetTextLineHeightWithSpacing() + ImGui::GetStyle().WindowPadding.y;
}

void ViewWindow::drawStatus() {
  const ImGuiIO& io = ImGui::GetIO();
  const float height = statusHeight();
  ImGui::SetNextWindowPos(ImVec2(0.0f, io.DisplaySize.y - height));
  ImGui::SetNextWindowSize(ImVec2(io.DisplaySize.x, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(6.0f, 3.0f));
  ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const std::string command = statusCommand();
  if (ImGui::SmallButton("copy")) copyCommand(false);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("copies this command line, which makes this very picture (C); Shift+C: of `gnomon compare`");
  ImGui::SameLine();
  // Less is drawn while something moves.
  if (picture_ && (picture_->width < picture_->fullWidth || picture_->mapHalvings > 0)) {
    ImGui::TextColored(kQuiet, "%d x %d, maps 1/%d:", picture_->width, picture_->height, 1 << picture_->mapHalvings);
    ImGui::SameLine();
  }
  ImGui::BeginGroup();
  for (const std::string& line : statusLines(statusCommands(), ImGui::GetContentRegionAvail().x))
    ImGui::TextUnformatted(line.c_str());
  ImGui::EndGroup();
  if (ImGui::IsItemHovered()) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(0.8f * io.DisplaySize.x);
    ImGui::TextUnformatted(command.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void ViewWindow::drawMessages() {
  // What is wrong stays as long as it is.
  if (ViewClock::now() - messageTime_ > kMessage) message_.clear();
  const std::string said = message_ == pictureProblem_ ? "" : message_;
  if (said.empty() && pictureProblem_.empty()) return;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(canvas_.x) + 8.0f, static_cast<float>(canvas_.y) + 8.0f));
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::SetNextWindowSizeConstraints(ImVec2(0.0f, 0.0f),
                                      ImVec2(std::max(static_cast<float>(canvas_.width) - 16.0f, 64.0f), 1e4f));
  ImGui::Begin(
      "message", nullptr,
      kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(std::max(static_cast<float>(canvas_.width) - 32.0f, 48.0f));
  if (!pictureProblem_.empty()) ImGui::TextColored(kProblem, "%s", pictureProblem_.c_str());
  if (!said.empty() && messageIsProblem_) ImGui::TextColored(kProblem, "%s", said.c_str());
  if (!said.empty() && !messageIsProblem_) ImGui::TextUnformatted(said.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void ViewWindow::drawKeys() {
  if (!showKeys_) return;
  const ImGuiIO& io = ImGui::GetIO();
  ImGui::SetNextWindowPos(ImVec2(0.5f * io.DisplaySize.x, 0.5f * io.DisplaySize.y), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  const float width = std::min(60.0f * ImGui::GetFontSize(), 0.96f * io.DisplaySize.x);
  const float most = 0.96f * io.DisplaySize.y;
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0.0f), ImVec2(width, most));
  ImGui::SetNextWindowFocus();
  ImGui::Begin("keys", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch, 2.6f);
    for (const KeyHelp& key : kKeyHelp) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", key.keys);
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", key.does);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void ViewWindow::drawPanels() {
  drawStatus();
  if (showPanel_) {
    ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(panelWidth_), static_cast<float>(canvas_.height)));
    ImGui::Begin("controls", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    // What is counted stays in sight, whatever the controls above are scrolled to.
    ImGui::BeginChild("declared", ImVec2(0.0f, -std::min(countsHeight_, 0.5f * static_cast<float>(canvas_.height))));
    drawControls();
    ImGui::EndChild();
    const float top = ImGui::GetCursorPosY();
    drawCounts();
    if (picture_ && !picture_->note.empty()) {
      ImGui::PushTextWrapPos(0.0f);
      ImGui::TextUnformatted(picture_->note.c_str());
      ImGui::PopTextWrapPos();
    }
    ImGui::TextColored(kQuiet, "? lists the keys");
    countsHeight_ = ImGui::GetCursorPosY() - top;
    ImGui::End();
  }
  drawTimes();
  drawMessages();
  drawKeys();
}

}  // namespace gnomon
