#include "lab/fog/density_sequence.h"

#include "base/error.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// "smoke.####.vdb:density" without the grid.
std::string withoutGrid(const std::string& fileAndGrid) {
  const size_t extension = fileAndGrid.rfind(".vdb");
  return extension == std::string::npos ? fileAndGrid : fileAndGrid.substr(0, extension + 4);
}

// Where the file's own name begins: # in folders is no frame's number.
size_t nameBegin(const std::string& fileAndGrid) {
  const size_t slash = withoutGrid(fileAndGrid).rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

std::optional<int> leastNumber(const fs::path& folder, const std::string& before, const std::string& after) {
  std::optional<int> least;
  std::error_code failure;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure)) {
    const std::string name = it->path().filename().string();
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) continue;
    int number = 0;
    const char* last = name.data() + name.size() - after.size();
    const auto [stop, bad] = std::from_chars(name.data() + before.size(), last, number);
    if (bad == std::errc() && stop == last && number >= 0) least = std::min(least.value_or(number), number);
  }
  return least;
}

}  // namespace

bool DensitySequence::isOne(const std::string& fileAndGrid) {
  std::error_code failure;
  return fileAndGrid.find('#', nameBegin(fileAndGrid)) != std::string::npos &&
         !fs::exists(withoutGrid(fileAndGrid), failure);
}

DensitySequence::DensitySequence(const std::string& fileAndGrid, std::optional<int> first, int frames) {
  if (first && *first < 0) throw UsageError(fmt::format("--first-frame {}: frames are counted from 0", *first));
  const size_t begin = fileAndGrid.find('#', nameBegin(fileAndGrid)), end = fileAndGrid.find_first_not_of('#', begin);
  if (end == std::string::npos || fileAndGrid.find('#', end) != std::string::npos ||
      fileAndGrid.find('/', begin) != std::string::npos)
    throw UsageError(
        fmt::format("--density {}: write one run of # for the frame's number, as in smoke.####.vdb", fileAndGrid));
  before_ = fileAndGrid.substr(0, begin);
  after_ = fileAndGrid.substr(end);
  digits_ = end - begin;
  const fs::path stem(before_);
  const fs::path folder = stem.has_parent_path() ? stem.parent_path() : ".";
  const std::optional<int> least = first ? first : leastNumber(folder, stem.filename().string(), withoutGrid(after_));
  if (!least)
    throw fileError(fileAndGrid, fmt::format("has no file in {}", folder.string()), "name the files of a sequence");
  first_ = *least;
  for (int frame = 0; frame < frames; ++frame)
    if (const std::string name = withoutGrid(file(frame)); !fs::exists(name))
      throw fileError(name, "does not exist",
                      fmt::format("{} frames from {} on are asked for; give fewer --frames, or "
                                  "another --first-frame",
                                  frames, first_));
}

std::string DensitySequence::file(int frame) const {
  return fmt::format("{}{:0{}}{}", before_, first_ + frame, digits_, after_);
}

}  // namespace gnomon
