#include "base/file.h"

#include "base/error.h"
#include "base/message.h"
#include "base/terminal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <ostream>
#include <set>
#include <streambuf>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t kMostOfPipe = uint64_t{1} << 30;
constexpr std::string_view kAsidePrefix = ".gnomon-", kAsideSuffix = ".tmp";

WorldError writeError(const fs::path& path, int error) {
  return fileError(path.string(), "cannot be written", std::strerror(error));
}

// A stream to a descriptor, for ostreams that throw. Not even the last bytes can fail unseen: whoever is done calls
// sync, which throws.
class DescriptorBuffer final : public std::streambuf {
 public:
  DescriptorBuffer(int descriptor, fs::path path) : descriptor_(descriptor), path_(std::move(path)), bytes_(1 << 18) {
    restart();
  }

 private:
  void restart() { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

  void drain() {
    for (const char* at = pbase(); at < pptr();) {
      const ssize_t count = ::write(descriptor_, at, static_cast<size_t>(pptr() - at));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw writeError(path_, count == 0 ? ENOSPC : errno);
      at += count;
    }
    restart();
  }

  int_type overflow(int_type c) override {
    drain();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  int sync() override {
    drain();
    return 0;
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    drain();
    const int whence = from == std::ios_base::beg ? SEEK_SET : from == std::ios_base::cur ? SEEK_CUR : SEEK_END;
    return ::lseek(descriptor_, offset, whence);
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(position, std::ios_base::beg, mode);
  }

  int descriptor_;
  fs::path path_;
  std::vector<char> bytes_;
};

void writeThrough(int descriptor, const fs::path& path, const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor, path);
  std::ostream out(&buffer);
  out.exceptions(std::ios::badbit | std::ios::failbit);
  write(out);
  out.flush();
}

// For what cannot seek, as a pipe: all at once.
class MemoryBuffer final : public std::streambuf {
 public:
  std::string_view bytes() const { return bytes_; }

 private:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    const auto size = static_cast<size_t>(count);
    bytes_.resize(std::max(bytes_.size(), at_ + size));
    std::memcpy(bytes_.data() + at_, bytes, size);
    at_ += size;
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    xsputn(&byte, 1);
    return traits_type::not_eof(c);
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const size_t base = from == std::ios_base::beg ? 0 : from == std::ios_base::cur ? at_ : bytes_.size();
    at_ = static_cast<size_t>(static_cast<off_type>(base) + offset);
    return static_cast<off_type>(at_);
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(position, std::ios_base::beg, mode);
  }

  std::string bytes_;
  size_t at_ = 0;
};

void writeUnseekable(int descriptor, const fs::path& path, const std::function<void(std::ostream&)>& write) {
  MemoryBuffer memory;
  std::ostream gathered(&memory);
  gathered.exceptions(std::ios::badbit | std::ios::failbit);
  write(gathered);
  writeThrough(descriptor, path, [&](std::ostream& out) {
    out.write(memory.bytes().data(), static_cast<std::streamsize>(memory.bytes().size()));
  });
}

bool isBelow(const fs::path& path, const char* folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

// Where a name stands for the kernel's things and not for files: nothing is made or renamed there.
bool isOfTheKernel(const fs::path& path) {
  std::error_code failure;
  fs::path folder = fs::weakly_canonical(fs::absolute(path).parent_path(), failure);
  if (failure) folder = fs::absolute(path).parent_path().lexically_normal();
  return (isBelow(folder, "/dev") && !isBelow(folder, "/dev/shm")) || isBelow(folder, "/proc") ||
         isBelow(folder, "/sys");
}

enum class Kind { StandardOutput, Through, Regular };

struct Target {
  Kind kind = Kind::Regular;
  fs::path path;       // links followed
  bool isOld = false;  // there is such a file
  struct stat old = {};
};

bool isSameFile(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

Target targetOf(const fs::path& path) {
  if (path.empty()) throw WorldError("the name of a file to write is empty; name a file");
  if (path == "-") return {.kind = Kind::StandardOutput, .path = path};
  Target target{.path = path};
  struct stat standard = {};
  target.isOld = ::stat(path.c_str(), &target.old) == 0;
  if (target.isOld && S_ISDIR(target.old.st_mode)) throw fileError(path.string(), "is a folder", "name a file");
  if (target.isOld && (!S_ISREG(target.old.st_mode) || isOfTheKernel(path))) {
    const bool isStandard = ::fstat(STDOUT_FILENO, &standard) == 0 && isSameFile(standard, target.old);
    target.kind = isStandard ? Kind::StandardOutput : Kind::Through;
    return target;
  }
  target.path = followLinks(path);
  if (isOfTheKernel(target.path)) throw fileError(path.string(), "is no device", "write to another folder");
  return target;
}

// Held as long as the file is open, so that collectLeftovers knows that it is no leftover.
Descriptor openAside(const fs::path& aside, const fs::path& path) {
  Descriptor file(::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!file.isOpen() || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) throw writeError(path, errno);
  return file;
}

void replaceWhole(const Target& target, const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::error_code failure;
  const fs::path folder = target.path.has_parent_path() ? target.path.parent_path() : ".";
  fs::create_directories(folder, failure);
  if (failure) throw fileError(folder.string(), "cannot make this folder", failure.message());
  static std::mutex mutex;
  static std::set<fs::path> collected;
  {
    std::lock_guard lock(mutex);
    if (collected.insert(folder).second) collectLeftovers(folder);
  }
  const fs::path aside = asideIn(folder);
  try {
    Descriptor file = openAside(aside, path);
    writeThrough(file.get(), path, write);
    if (target.isOld) {
      [[maybe_unused]] const int kept = ::fchown(file.get(), target.old.st_uid, target.old.st_gid);  // if it may
      ::fchmod(file.get(), target.old.st_mode & 07777);
    }
    // Some file systems tell only now that there was no room.
    if (::close(file.release()) != 0) throw writeError(path, errno);
    if (::rename(aside.c_str(), target.path.c_str()) != 0) throw writeError(path, errno);
  } catch (...) {
    fs::remove(aside, failure);
    throw;
  }
}

bool mayEnterAndWrite(const fs::path& folder) {
  return ::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

// The process of an aside's name, 0 where it is no such name.
pid_t writerOf(std::string_view name) {
  if (!name.starts_with(kAsidePrefix) || !name.ends_with(kAsideSuffix)) return 0;
  name.remove_prefix(kAsidePrefix.size());
  name.remove_suffix(kAsideSuffix.size());
  pid_t process = 0;
  uint64_t number = 0;
  const char* end = name.data() + name.size();
  const auto [dash, bad] = std::from_chars(name.data(), end, process);
  if (bad != std::errc() || dash == end || *dash != '-') return 0;
  const auto [last, worse] = std::from_chars(dash + 1, end, number);
  return worse == std::errc() && last == end && process > 0 ? process : 0;
}

// Both must hold: another machine's process may have any number, and a file is not yet locked when it is new.
bool isAbandoned(const fs::path& path, pid_t writer) {
  if (::kill(writer, 0) == 0 || errno != ESRCH) return false;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  return file.isOpen() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0;
}

}  // namespace

Descriptor::~Descriptor() {
  if (isOpen()) ::close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

int Descriptor::release() noexcept {
  return std::exchange(number_, -1);
}

fs::path followLinks(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as the kernel
  fs::path at = path;
  std::error_code failure;
  for (int i = 0; i < kMostLinks; ++i) {
    if (!fs::is_symlink(fs::symlink_status(at, failure))) return at;
    const fs::path link = fs::read_symlink(at, failure);
    if (failure) throw fileError(path.string(), "cannot be followed", failure.message());
    at = at.parent_path() / link;  // an absolute one stays as it is
  }
  throw fileError(path.string(), "is a symbolic link that ends nowhere", "name a file");
}

void writeFile(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  const Target target = targetOf(path);
  if (target.kind == Kind::Regular) return replaceWhole(target, path, write);
  if (target.kind == Kind::StandardOutput) {
    giveStandardOutputAway();
    std::fflush(stdout);
    return writeUnseekable(STDOUT_FILENO, path == "-" ? "standard output" : path, write);
  }
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
  if (!file.isOpen()) throw writeError(path, errno);
  writeUnseekable(file.get(), path, write);
}

void writeTextFile(const fs::path& path, std::string_view text) {
  writeFile(path, [&](std::ostream& out) { out.write(text.data(), static_cast<std::streamsize>(text.size())); });
}

void checkOutput(const fs::path& path) {
  const Target target = targetOf(path);
  if (target.kind == Kind::StandardOutput) {
    static bool isTaken = false;
    if (isTaken)
      throw UsageError(fmt::format("{}: one file can go to standard output; name another for the rest", path.string()));
    isTaken = true;
    return giveStandardOutputAway();
  }
  if (target.isOld && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) throw writeError(path, errno);
  if (target.kind == Kind::Through) return;
  std::error_code failure;
  fs::path folder = fs::absolute(target.path).parent_path();
  while (!fs::exists(folder, failure) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, failure))
    throw fileError(path.string(), "cannot be written", fmt::format("{} is not a folder", folder.string()));
  if (!mayEnterAndWrite(folder))
    throw fileError(path.string(), "cannot be written", fmt::format("{}: {}", folder.string(), std::strerror(errno)));
}

bool isStream(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  return path == "-" || (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status));
}

std::string readRegularFile(const fs::path& path, uint64_t most) {
  std::error_code failure;
  if (fs::exists(path, failure) && !fs::is_directory(path, failure) && !fs::is_regular_file(path, failure))
    throw fileError(path.string(), "is no regular file", "name one");
  return readFile(path, most);
}

std::string readFile(const fs::path& path, uint64_t most) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) throw fileError(path.string(), "is a folder", "name a file");
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  if (!file.isOpen()) throw fileError(path.string(), "cannot be read", std::strerror(errno));
  const auto tooLarge = [&] {
    return fileError(path.string(), fmt::format("has more than {} bytes", most), "name a smaller file");
  };
  struct stat status = {};
  if (::fstat(file.get(), &status) != 0) throw fileError(path.string(), "cannot be read", std::strerror(errno));
  // Its end may never come.
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) throw fileError(path.string(), "is a device", "name a file");
  if (!S_ISREG(status.st_mode)) most = std::min(most, kMostOfPipe);
  if (S_ISREG(status.st_mode) && static_cast<uint64_t>(status.st_size) > most) throw tooLarge();
  // One byte more than it says, to see its end; what is no file says 0.
  constexpr size_t kChunk = 1 << 16;
  std::string bytes(static_cast<size_t>(std::max<off_t>(status.st_size, 0)) + 1, '\0');
  size_t size = 0;
  while (true) {
    if (size == bytes.size()) bytes.resize(size + std::max(size / 2, kChunk));
    const ssize_t count = ::read(file.get(), bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw fileError(path.string(), "cannot be read", std::strerror(errno));
    if (count == 0) break;
    size += static_cast<size_t>(count);
    if (size > most) throw tooLarge();
  }
  bytes.resize(size);
  return bytes;
}

fs::path asideIn(const fs::path& folder) {
  static std::atomic<uint64_t> count{0};
  return folder / fmt::format("{}{}-{}{}", kAsidePrefix, ::getpid(), count++, kAsideSuffix);
}

void collectLeftovers(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure)) {
    const pid_t writer = writerOf(it->path().filename().string());
    if (writer != 0 && isAbandoned(it->path(), writer)) leftovers.push_back(it->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, failure);
}

}  // namespace gnomon
