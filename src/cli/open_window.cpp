// `gnomon view`: this process becomes gnomon-view.

#include "base/error.h"
#include "cli/typed_command.h"
#include "cli/view_flags.h"

#include "window_place.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

namespace gnomon {

int openWindow(const ViewFlags&) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::path own = fs::read_symlink("/proc/self/exe", failure).parent_path();
  for (const char* place : {kModulesFromBuild, kModulesFromBin}) {
    const fs::path program = own / place / "gnomon-view";
    if (::access(program.c_str(), X_OK) != 0) continue;
    std::vector<std::string> words = typedWords();
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    throw WorldError(fmt::format("{}: {}", program.string(), std::strerror(errno)));
  }
  throw WorldError(
      "this build has no window: gnomon-view is missing; apt-get install libglfw3-dev libimgui-dev, then configure and "
      "build again");
}

}  // namespace gnomon
