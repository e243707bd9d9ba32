#include "lab/store/workers.h"

#include "base/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Byte 0 is read-locked by all workers, so that one can tell whether it is the last.
constexpr int64_t kAll = 0;

struct flock lockOf(short type, int64_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

bool take(int file, short type, int64_t byte) {
  struct flock lock = lockOf(type, byte);
  return ::fcntl(file, F_OFD_SETLK, &lock) == 0;
}

bool isHeld(int file, int64_t byte) {
  struct flock lock = lockOf(F_WRLCK, byte);
  return ::fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

std::filesystem::path besideOf(const std::filesystem::path& store) {
  return store.string() + "-workers";
}

bool isSameFile(int file, const std::filesystem::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

}  // namespace

Workers::Workers(const std::filesystem::path& store) : path_(besideOf(store)) {
  // The last of those before may remove the file between our opening and our locking it.
  for (int tries = 0; tries < 1000; ++tries) {
    file_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file_.isOpen())
      throw fileError(path_.string(), fmt::format("cannot be made: {}", std::strerror(errno)),
                      "check the folder of the store and its permissions");
    if (!take(file_.get(), F_RDLCK, kAll)) {
      if (errno != EAGAIN && errno != EACCES)
        throw fileError(path_.string(), fmt::format("cannot be locked: {}", std::strerror(errno)),
                        "put the store on a disk of this machine");
      ::usleep(1000);
      continue;
    }
    if (isSameFile(file_.get(), path_)) return;
  }
  throw fileError(path_.string(), "cannot be locked", "end what else holds it and run the same command again");
}

Workers::~Workers() {
  if (take(file_.get(), F_WRLCK, kAll) && isSameFile(file_.get(), path_)) ::unlink(path_.c_str());
}

bool Workers::become(int64_t number) {
  return take(file_.get(), F_WRLCK, number);
}

bool Workers::isAlive(int64_t number) const {
  return isHeld(file_.get(), number);
}

bool Workers::anyAt(const std::filesystem::path& store) {
  const Descriptor file(::open(besideOf(store).c_str(), O_RDWR | O_CLOEXEC));
  return file.isOpen() && isHeld(file.get(), kAll);
}

}  // namespace gnomon
