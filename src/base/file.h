#pragma once
// Atomic file writes: to a temporary file, which is then renamed, so that no half-written file has its final name.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace gnomon {

// Calls `write` with a path beside `path` (same folder, same extension), then renames that file to `path`.
// When `write` throws, nothing is left behind. Parent folders are made. Throws WorldError.
void writeAtomically(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path& aside)>& write);

void writeTextFile(const std::filesystem::path& path, std::string_view text);

// The whole file as bytes. Throws WorldError.
std::string readFile(const std::filesystem::path& path);

}  // namespace gnomon
