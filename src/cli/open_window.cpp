// `gnomon view`: this process becomes gnomon-view.

#include "base/error.h"
#include "base/program_place.h"
#include "cli/typed_command.h"
#include "cli/view_flags.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

int openWindow(const ViewFlags&) {
  std::string program;
  try {
    program = findProgram("gnomon-view");
  } catch (const WorldError&) {
    throw WorldError(
        "this build has no window: gnomon-view is missing; apt-get install libglfw3-dev libimgui-dev, then configure "
        "and "
        "build again");
  }
  std::vector<std::string> words = typedWords();
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  throw WorldError(fmt::format("{}: {}", program, std::strerror(errno)));
}

}  // namespace gnomon
