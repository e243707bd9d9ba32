#pragma once
// What `gnomon view` is asked for on the command line.

#include "view/view_state.h"

#include <optional>
#include <string>

namespace gnomon {

struct ViewOptions {
  ViewState state;
  std::string device;
  std::string session;             // a file to begin with, and to save to; empty: none
  bool namesOthers = false;        // the command line has a scene or a bias, too, which a session sets
  std::string script;              // empty: none
  std::string screenshot;          // of the window, at the end; empty: none
  std::string picture;             // of side A, at the end
  std::string json;                // measurements; empty: none
  std::optional<int> frames;       // ends when refined and after so many
  int width = 1280, height = 800;  // of the window, pixels
  double scale = 0.0;              // of the interface; 0: the display's
};

// Opens the window and runs until it is closed; the exit code. Throws WorldError.
int runWindow(const ViewOptions& options);

}  // namespace gnomon
