#pragma once
// The flags of `gnomon view`. The window itself is a program of its own, gnomon-view, which alone links what opens
// windows; it declares the same flags by the same code.

#include "cli/method_flags.h"
#include "cli/scene_flags.h"

#include <optional>
#include <string>

namespace gnomon {

struct ViewFlags {
  SceneFlags scene;
  MethodFlags method;
  std::string show = "beauty";
  bool biasIsGiven = false;
  std::string session, script, screenshot, picture, json;
  std::optional<int> frames;
  std::string window = "1280x800";
  double scale = 0.0;
};

// Opens the window, and returns the exit code when it is closed. Of gnomon: becomes gnomon-view. Throws WorldError
// where that was not built.
int openWindow(const ViewFlags& flags);

}  // namespace gnomon
