#include "cli/output_flags.h"

#include "base/error.h"
#include "base/file.h"
#include "cli/offers.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// Of all verbs; what each writes there replaces what was there. (A store, --db, and a session are gone on with.)
constexpr std::array<std::string_view, 9> kWritten = {"--out", "--json", "--csv",        "--latex",  "--markdown",
                                                      "--svg", "--vdb",  "--screenshot", "--picture"};

bool areOne(const fs::path& a, const fs::path& b) {
  std::error_code failure;
  if (fs::equivalent(a, b, failure)) return true;
  return fs::absolute(a, failure).lexically_normal() == fs::absolute(b, failure).lexically_normal();
}

// What a run writes into a folder itself: its tables and its page, and pictures in folders below.
bool isOfFolder(const fs::path& folder, const fs::path& file) {
  std::error_code failure;
  const auto place = [&](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path, failure), failure); };
  const fs::path inside = place(file).lexically_relative(place(folder));
  if (inside.empty() || *inside.begin() == "..") return false;
  if (inside.has_parent_path()) return inside.extension() == ".png" || inside.extension() == ".exr";
  constexpr std::array<std::string_view, 3> kNames = {"results.json", "report.html", "volume.json"};
  return std::ranges::find(kNames, inside.string()) != kNames.end();
}

// What a folder of results is read by.
bool isReadBy(const fs::path& read, const fs::path& written) {
  std::error_code failure;
  return areOne(read, written) || (fs::is_directory(read, failure) && areOne(read / "results.json", written));
}

}  // namespace

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

void refuseToWriteOverInputs(const CLI::App& verb) {
  std::vector<std::pair<std::string, std::string>> written, folders;  // flag, file
  const auto isWritten = [](const CLI::Option& option) {
    return std::ranges::find(kWritten, option.get_name()) != kWritten.end();
  };
  std::error_code failure;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0 || !isWritten(*option)) continue;
    const std::string file = option->results().front();
    if (isStream(file)) continue;
    const Offers& offers = offersOf(option);
    const bool isFolder = offers.kind == Offers::Kind::Folders || (offers.isFolder != nullptr && offers.isFolder(file));
    if (isFolder) folders.emplace_back(option->get_name(), file);
    if (fs::is_directory(file, failure)) continue;
    for (const auto& [flag, other] : written)
      if (areOne(other, file))
        throw UsageError(fmt::format("{} {}: {} writes there, too; name another file", option->get_name(), file, flag));
    written.emplace_back(option->get_name(), file);
  }
  for (const auto& [flag, file] : written)
    for (const auto& [of, folder] : folders)
      if (isOfFolder(folder, file))
        throw UsageError(fmt::format("{} {}: {} writes there, too; name another file", flag, file, of));
  for (const CLI::Option* option : verb.get_options()) {
    const Offers& offers = offersOf(option);
    if (option->count() == 0 || isWritten(*option) || offers.kind != Offers::Kind::Files) continue;
    for (const std::string& read : option->results())
      for (const auto& [flag, file] : written)
        if (std::ranges::find(offers.values, read) == offers.values.end() && fs::exists(read, failure) &&
            isReadBy(read, file))  // and no generated scene's name
          throw UsageError(fmt::format("{} {}: this run reads that file; name another one to write", flag, file));
  }
}

}  // namespace gnomon
