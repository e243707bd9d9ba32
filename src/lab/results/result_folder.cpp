#include "lab/results/result_folder.h"

#include "base/error.h"
#include "base/parse_json.h"
#include "lab/results/results_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

// CRC-32 as in gzip: it tells one run's picture from another's, and `gzip` or Python can check it.
std::string checksum(const fs::path& path) {
  const std::string bytes = readFile(path);
  return fmt::format("{:08x}", crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Descriptor held(const fs::path& folder) {
  Descriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!lock.isOpen()) throw fileError(folder.string(), "cannot be opened", std::strerror(errno));
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0)
    throw fileError(folder.string(), "another gnomon is writing there", "wait for it, or choose another folder");
  return lock;
}

constexpr size_t kSumDigits = 8;

// Of a line of FileSums; empty where it leads out of the folder, or is no such line.
fs::path pathOf(const std::string& line) {
  if (line.size() < kSumDigits + 2 || line[kSumDigits] != ' ') return {};
  const fs::path path = line.substr(kSumDigits + 1);
  return path.is_relative() && *path.lexically_normal().begin() != ".." ? path : fs::path();
}

std::string sumOf(const std::string& line) {
  return line.substr(0, kSumDigits);
}

// What a results file lists, nothing where it cannot be read: it is about to be replaced.
FileSums listedIn(const fs::path& index) {
  try {
    return parseJson<nlohmann::json>(readRegularFile(index, kMostResultsBytes), {}).at("files").get<FileSums>();
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& folder, const char* index) : folder_(folder), index_(folder / index) {
  if (folder.empty()) return;
  std::error_code failure;
  isNew_ = fs::create_directories(followLinks(folder), failure);
  if (failure) throw fileError(folder.string(), "cannot make this folder", failure.message());
  lock_ = held(folder);
  collectLeftovers(folder);
  aside_ = asideIn(folder);
  if (!fs::create_directory(aside_, failure)) throw fileError(folder.string(), "cannot be written", failure.message());
  asideLock_ = held(aside_);
}

ResultFolder::~ResultFolder() {
  std::error_code failure;
  if (aside_.empty()) return;
  fs::remove_all(aside_, failure);
  if (isNew_) fs::remove(followLinks(folder_), failure);  // where it is empty
}

FileSums ResultFolder::files() const {
  FileSums files;
  if (aside_.empty()) return files;
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(aside_))
    if (entry.is_regular_file()) paths.push_back(entry.path().lexically_relative(aside_).generic_string());
  std::ranges::sort(paths);
  for (const std::string& path : paths) files.push_back(checksum(aside_ / path) + " " + path);
  return files;
}

// By their checksums, so that none goes that somebody else has put there.
void ResultFolder::removeOldFiles(const FileSums& old, const FileSums& written) const {
  std::error_code failure;
  std::set<fs::path> kept;
  for (const std::string& line : written) kept.insert(pathOf(line));
  for (const std::string& line : old) {
    const fs::path path = pathOf(line);
    if (path.empty() || kept.contains(path) || !fs::is_regular_file(folder_ / path, failure)) continue;
    if (checksum(folder_ / path) == sumOf(line)) fs::remove(folder_ / path, failure);
    const fs::path parent = (folder_ / path).parent_path();
    if (parent != folder_ && fs::is_empty(parent, failure)) fs::remove(parent, failure);
  }
}

void ResultFolder::publish() {
  if (aside_.empty()) return;
  try {
    const FileSums old = listedIn(index_), written = files();
    fs::remove(index_);
    removeOldFiles(old, written);
    for (const std::string& line : written) {
      const fs::path path = pathOf(line);
      if (folder_ / path == index_) continue;
      fs::create_directories((folder_ / path).parent_path());
      fs::rename(aside_ / path, folder_ / path);
    }
    fs::rename(aside_ / index_.filename(), index_);
    fs::remove_all(aside_);
  } catch (const fs::filesystem_error& error) {
    throw fileError(error.path1().string(), "cannot be put in its place", error.code().message());
  }
  isNew_ = false;
}

void checkFiles(const fs::path& folder, const FileSums& files) {
  std::error_code failure;
  for (const std::string& line : files) {
    const fs::path path = pathOf(line);
    if (path.empty() || !fs::is_regular_file(folder / path, failure)) continue;
    if (checksum(folder / path) != sumOf(line))
      throw fileError((folder / path).string(), "is not the one that results.json lists",
                      "it is of another run; make both again with gnomon compare -o or gnomon fog -o");
  }
}

}  // namespace gnomon
