#pragma once
// What opening a file asks of the compiler, beside the window: seconds for a large bias, and the window goes on.

#include "view/view_state.h"

#include <memory>
#include <string>

namespace gnomon {

class FileCheck {
 public:
  // Whether a file of that name, a bias's or a session's, may ask for the compiler.
  static bool isFor(const std::string& path);
  // Begins, in a thread of its own. `state`: what a session leaves as it is.
  FileCheck(const std::string& path, const ViewState& state);

  bool isDone() const;
  // Throws what was thrown. Else opening the file now compiles nothing. Only when it is done.
  void rethrow() const;

 private:
  struct Outcome;
  std::shared_ptr<Outcome> outcome_;  // the thread's, too: nobody waits for it where the window ends first
};

// A session's text; throws where it is none, or too long.
std::string readSessionFile(const std::string& path);

}  // namespace gnomon
