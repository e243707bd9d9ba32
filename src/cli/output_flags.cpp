#include "cli/output_flags.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

namespace gnomon {

void checkFolderName(const std::string& out, const std::string& remedy) {
  constexpr std::array<std::string_view, 22> kFileEndings = {
      ".mp4", ".mkv", ".webm", ".mov", ".avi", ".gif", ".apng", ".png",  ".jpg", ".jpeg", ".exr",
      ".hdr", ".tif", ".tiff", ".svg", ".bmp", ".pdf", ".html", ".json", ".csv", ".vdb",  ".glb"};
  std::error_code failure;
  if (out.empty() || std::filesystem::is_directory(out, failure)) return;
  std::string ending = std::filesystem::path(out).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (out != "-" && std::ranges::find(kFileEndings, ending) == kFileEndings.end()) return;
  throw UsageError(fmt::format("-o {}: a folder is made there, and that is the name of {}; {}", out,
                               out == "-" ? "standard output" : "a file", remedy));
}

}  // namespace gnomon
