#pragma once
// The window: what is on it, what a person does there, and what becomes of it. Of gnomon-view alone.

#include "view/file_check.h"
#include "view/picture_worker.h"
#include "view/pixel_facts.h"
#include "view/presenter.h"
#include "view/view_controls.h"
#include "view/view_options.h"
#include "view/view_script.h"

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

struct GLFWwindow;

namespace gnomon {

using ViewClock = std::chrono::steady_clock;

// Times of a stage, of the newest pictures.
struct StageHistory {
  std::string name;
  std::deque<float> ms;
  double median() const;
};
inline constexpr size_t kMostTimes = 120;
// How long a message stands.
inline constexpr std::chrono::seconds kMessage{8};

// What was measured during one stretch of a script.
struct Measurement {
  std::string name;
  int pictures = 0;
  int frames = 0;
  double seconds = 0.0;
  std::vector<double> latencies;  // milliseconds from an input to its picture on the window
  std::vector<double> shares;     // of the full picture's side
  std::vector<double> halvings;   // of the maps' sides
};

// Where the picture stands in the window, pixels; `scale`: window pixels a pixel of the full picture.
struct PicturePlace {
  PixelRect rect;
  float scale = 1.0f;
  int fullWidth = 0, fullHeight = 0;
};

// A key that was pressed, and with what: between two frames many may be, in their order, and be let go.
struct KeyTap {
  int key = 0;  // GLFW's; 0: none
  bool ctrl = false, shift = false;
};

// A mouse button that went down or up, and where.
struct ButtonTurn {
  int button = 0;  // GLFW's
  bool isDown = false;
  glm::vec2 at{};
  bool ctrl = false, shift = false;
};

struct WheelTurn {
  float steps = 0.0f;
};

using InputEvent = std::variant<KeyTap, ButtonTurn, WheelTurn, char32_t>;

// Input that a script gives in place of a person.
struct ScriptedInput {
  bool drives = false;  // the mouse
  float x = 0.0f, y = 0.0f;
  bool buttons[3] = {};
  float wheel = 0.0f;
  std::vector<int> keys;  // held in this frame
  bool ctrl = false, shift = false;
};

inline glm::dvec3 eyeOf(const glsl::CameraView& camera) {
  return glm::dvec3(camera.eyeW);
}

class ViewWindow {
 public:
  explicit ViewWindow(const ViewOptions& options);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;
  int run();
  // Saves the state where a session is saved; the file.
  std::string rescueSession() const;

 private:
  friend class ScriptPlayer;

  // view_window.cpp
  void createWindow();
  bool isAtRest() const;
  bool wantsFrame() const;
  void waitForEvents();
  void frame();
  void takePicture();
  void ask();
  void writeJson() const;
  std::vector<Presenter::Shown> shownPictures() const;
  bool isOfCamera(int side) const;  // and not what a map holds
  void uploadPictures();
  void present();
  void remakePresenter();

  // view_editing.cpp
  void noteChange(bool goesOn);
  void rememberState();
  void undo();
  void redo();
  void openFile(const std::string& path);
  void openDropped();
  bool opensDropped() const;
  void say(const std::string& line, bool isProblem);
  // What goes wrong becomes a line in the window.
  template <typename Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (const std::exception& error) {
      say(error.what(), true);
    }
  }
  void remakeControls();
  void followBiasFiles();
  void setControl(std::string name, std::string value);
  std::string getControl(std::string name);
  void saveSession(const std::string& path);
  // Of a file that is not there: "stem-0001.png".
  static std::string freeName(const std::string& stem);
  void writePictureFile(const std::string& path, int side);
  void copyCommand(bool ofComparison);
  std::pair<int, int> pictureSize() const;
  // Of the picture, or of both pictures one after the other; and of their comparison.
  std::vector<std::string> statusCommands() const;  // of A, or of A and B
  std::string statusCommand() const;
  std::string compareCommandOfSides() const;

  // view_panels.cpp
  void drawPanels();
  void drawControls();
  void drawControl(const Control& control);
  void drawNumber(const Control& control);
  void drawFogNotes();
  void drawCounts();
  void drawTimes();
  static float statusHeight();  // pixels
  void drawStatus();
  void drawKeys();
  void drawMessages();

  // view_canvas.cpp
  // Where the light is taken hold of, pixels of the window: itself, and the ends of its axes, so many metres long; of a
  // sun the one it shines from.
  struct LightHandles {
    std::optional<glm::vec2> middle;
    std::array<std::optional<glm::vec2>, 3> tips;
    double metres = 0.0;
  };
  LightHandles lightHandles(const Light& light) const;
  void layOut();
  void drawCanvas();
  void drawSplitEdge();
  void drawGizmo();
  void drawLoupe();
  void drawUnfoldedCursor();
  void drawLegend();
  std::optional<glm::vec2> project(const glm::dvec3& pointW) const;  // to window pixels
  RayD rayAt(float x, float y) const;
  int sideAt(float x) const;
  glm::ivec2 pixelAt(float x, float y) const;  // of the picture as drawn

  // view_input.cpp
  void handleMouse();
  void listenToInput();
  std::optional<KeyTap> takeInput();
  void handleKeys(const KeyTap& tap);
  void navigate(float dx, float dy, int how);
  glm::dvec3 pivot();
  void turnLight(double degrees, double liftDegrees);
  void turnCamera(double degrees);

  ViewOptions options_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Presenter> presenter_;
  std::unique_ptr<PictureWorker> worker_;
  std::unique_ptr<class ScriptPlayer> script_;

  ViewState state_;
  std::vector<Control> controls_;
  std::array<uint64_t, kSideCount> controlsFiles_{};  // the bias files whose parameters are among them
  std::shared_ptr<const ViewPicture> picture_;
  std::shared_ptr<const TracedScene> traced_;

  // Requests.
  uint64_t number_ = 0;  // of the state that was asked for last
  bool changed_ = false, goesOn_ = false, restAsked_ = true;
  ViewClock::time_point lastChange_, inputTime_;
  std::map<uint64_t, ViewClock::time_point> inputTimes_;
  int askedWidth_ = 0, askedHeight_ = 0;

  // Undo: states as sessions, the newest last.
  std::vector<std::string> past_, future_;
  std::string current_;
  ViewState goodState_;  // of the last picture without a problem

  // What the canvas does.
  PixelRect canvas_, unfoldedRect_;
  int unfoldedRoom_ = 0;                        // pixels of the canvas's height
  int unfoldedWidth_ = 0, unfoldedHeight_ = 0;  // of the newest unfolded map, which stays while something moves
  PicturePlace place_;
  enum class Drag { None, Orbit, Pan, Edge, Light, LightAxis, LightTurn } drag_ = Drag::None;
  int dragAxis_ = 0;
  std::optional<glm::dvec3> pivot_;
  bool showKeys_ = false, showTimes_ = false, showPanel_ = true, redrawKept_ = false;
  bool keepFrame_ = false;
  float scale_ = 1.0f;
  double panelWidth_ = 0.0;
  float countsHeight_ = 60.0f;  // of what stands below the controls, pixels

  // Messages.
  std::string message_;
  bool messageIsProblem_ = false;
  ViewClock::time_point messageTime_;
  std::string pictureProblem_;

  struct Typed {
    std::string control, value;
    int frame = -2;  // the last one in which it was being typed
  };
  Typed typed_;  // a number that is not set yet

  std::deque<std::string> dropped_;    // files that are not opened yet
  std::optional<FileCheck> check_;     // of the first
  std::deque<InputEvent> input_;       // that no frame has seen yet, in its order
  glm::vec2 pointer_{};                // where it was at the last event
  std::array<bool, 3> buttons_{};      // of the mouse, as the frames have seen them
  glm::vec2 mouse_{};                  // of the last frame
  int lastTapped_ = 0;                 // the key of the last frame
  std::set<int> pressedWithModifier_;  // when last pressed, with Ctrl or Alt: held on without it, they do not fly
  ScriptedInput scripted_;
  std::vector<StageHistory> times_;
  std::vector<Measurement> measurements_;
  std::vector<double> latencies_;
  double firstPictureMs_ = 0.0;
  int presentedPictures_ = 0, framesDrawn_ = 0;
  bool quits_ = false, scriptWaits_ = false;  // the script waits for a picture
  int framesPending_ = 3;
  uint64_t shownNumber_ = 0, timedNumber_ = 0;
  ViewClock::time_point lastLoss_;
  size_t forgottenMessages_ = 0;  // of the validation layers, of presenters that are gone
  ViewClock::time_point lastFrame_;
  float frameSeconds_ = 0.016f;
};

// Plays a script, a part of it a frame.
class ScriptPlayer {
 public:
  ScriptPlayer(ViewWindow& window, std::string name, std::vector<ScriptLine> lines);
  // Before a frame of the window: what is done in it. False when the script is done.
  bool step();
  bool isDone() const { return at_ >= lines_.size() && waiting_ == nullptr; }

 private:
  using Wait = std::function<bool()>;  // false: go on
  void play(const ScriptLine& line);
  void playInput(const ScriptLine& line);
  void playOutput(const ScriptLine& line);
  void wait(Wait work) { waiting_ = std::move(work); }
  void animate(const ScriptLine& line);
  void rest(int frames);
  void turntable(const ScriptLine& line);
  void random(int frames, unsigned seed);
  void pressKey(const std::string& text, int frames);
  void moveTo(double x, double y);
  bool isRefined() const;
  bool lacksScene(const ScriptLine& line) const;
  void checkPatience(const ScriptLine& line);
  [[noreturn]] void fail(const ScriptLine& line, const std::string& what) const;

  ViewWindow& window_;
  std::string name_;
  std::vector<ScriptLine> lines_;
  size_t at_ = 0;
  Wait waiting_;
  const ViewPicture* seen_ = nullptr;
  ViewClock::time_point lastSign_ = ViewClock::now();
};

// GLFW's key of a name: "a", "7", "tab", "f1", "left"; none: -1.
int keyNamed(const std::string& name);

}  // namespace gnomon
