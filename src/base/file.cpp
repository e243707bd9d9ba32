#include "base/file.h"

#include "base/error.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

// Beside the target, so that the rename stays within one file system; the process id keeps two runs apart.
fs::path asidePath(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}.{}{}", path.stem().string(), ::getpid(), path.extension().string());
}

}  // namespace

void writeAtomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  std::error_code failure;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), failure);
  if (failure) throw fileError(path.parent_path().string(), "cannot make this folder", failure.message());
  const fs::path aside = asidePath(path);
  try {
    write(aside);
    fs::rename(aside, path);
  } catch (const fs::filesystem_error& error) {
    fs::remove(aside, failure);
    throw fileError(path.string(), "cannot be written", error.code().message());
  } catch (...) {
    fs::remove(aside, failure);
    throw;
  }
}

void writeTextFile(const fs::path& path, std::string_view text) {
  writeAtomically(path, [&](const fs::path& aside) {
    std::ofstream out(aside, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) throw fileError(path.string(), "cannot be written", "check that the folder exists and has room");
  });
}

std::string readFile(const fs::path& path) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) throw fileError(path.string(), "is a folder", "name a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw fileError(path.string(), "cannot be read", std::strerror(errno));
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) throw fileError(path.string(), "cannot be read", "the file system reports an error");
  return bytes;
}

}  // namespace gnomon
