#include "lab/results/result_folder.h"

#include "base/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

bool staysWithin(const fs::path& path) {
  return !path.empty() && path.is_relative() && *path.lexically_normal().begin() != "..";
}

// Those that a results file lists, nothing where it cannot be read: it is about to be replaced.
NamedTexts listedIn(const fs::path& index) {
  NamedTexts listed;
  try {
    constexpr uint64_t kMostBytes = 64 << 20;
    const auto json = nlohmann::json::parse(readFile(index, kMostBytes), [](int depth, auto, auto&) {
      if (depth > 64) throw WorldError("nested too deep");
      return true;
    });
    for (const auto& [path, sum] : json.at("files").items()) listed.emplace_back(path, sum.get<std::string>());
  } catch (const std::exception&) {
    listed.clear();
  }
  return listed;
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& folder, const char* index) : folder_(folder), index_(folder / index) {
  if (folder.empty()) return;
  std::error_code failure;
  isNew_ = fs::create_directories(folder, failure);
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
  if (isNew_) fs::remove(folder_, failure);  // where it is empty
}

NamedTexts ResultFolder::files() const {
  NamedTexts files;
  if (aside_.empty()) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(aside_))
    if (entry.is_regular_file())
      files.emplace_back(entry.path().lexically_relative(aside_).generic_string(), checksum(entry.path()));
  std::ranges::sort(files);
  return files;
}

// By their checksums, so that none goes that somebody else has put there.
void ResultFolder::removeOldFiles(const NamedTexts& old, const NamedTexts& written) const {
  std::error_code failure;
  for (const auto& [path, sum] : old) {
    const bool isWritten = std::ranges::any_of(written, [&](const auto& file) { return file.first == path; });
    if (isWritten || !staysWithin(path) || !fs::is_regular_file(folder_ / path, failure)) continue;
    if (checksum(folder_ / path) == sum) fs::remove(folder_ / path, failure);
    const fs::path parent = (folder_ / path).parent_path();
    if (parent != folder_ && fs::is_empty(parent, failure)) fs::remove(parent, failure);
  }
}

void ResultFolder::publish() {
  if (aside_.empty()) return;
  try {
    const NamedTexts old = listedIn(index_), written = files();
    fs::remove(index_);
    removeOldFiles(old, written);
    for (const auto& [path, sum] : written) {
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

void checkFiles(const fs::path& folder, const NamedTexts& files) {
  std::error_code failure;
  for (const auto& [path, sum] : files) {
    if (!staysWithin(path) || !fs::is_regular_file(folder / path, failure) || checksum(folder / path) == sum) continue;
    throw fileError((folder / path).string(), "is not the one that results.json lists",
                    "it is of another run; make both again with gnomon compare -o or gnomon fog -o");
  }
}

}  // namespace gnomon
