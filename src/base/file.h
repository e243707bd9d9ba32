#pragma once
// The one way in and out for files. A file is written whole or not at all: aside, every write checked, then renamed.
// What a kill leaves aside is removed by the next run that writes there.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace gnomon {

// Calls `write` with a stream whose failures throw, and which can seek. Where the file goes:
//   a file, or nothing yet   beside it, then renamed to it; its folders are made, and it keeps its permissions
//   a symbolic link          to what it points at
//   a device or a pipe       through it
//   "-"                      to standard output; what the run has to say then goes to standard error (terminal.h)
// Throws WorldError, and what `write` throws; then nothing is left behind and an old file is as it was.
void writeFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void writeTextFile(const std::filesystem::path& path, std::string_view text);

// Throws WorldError where writing there is bound to fail: a folder that is not there and cannot be made, no permission.
// For before the work, so that hours of it are not lost; changes nothing. Throws UsageError where a second file is to
// go to standard output, where the two could not be told apart.
void checkOutput(const std::filesystem::path& path);

// Where the symbolic links at the end of a path lead, whether there is something or not; the path itself where it is
// none. Throws WorldError where they go round.
std::filesystem::path followLinks(const std::filesystem::path& path);

// Whether it is "-", a device or a pipe, whose name tells nothing of what is to be written.
bool isStream(const std::filesystem::path& path);

// The whole file as bytes. Throws WorldError, also where it has more than `most`, and of a device. A pipe is read to
// its end, of at most 1 GiB.
std::string readFile(const std::filesystem::path& path, uint64_t most = uint64_t{8} << 30);
// The same of a regular file alone: for names that another file gives, where a pipe would be waited for.
std::string readRegularFile(const std::filesystem::path& path, uint64_t most = uint64_t{8} << 30);

// A name for what is written aside in a folder, unlike any other's. A file or folder of such a name is held (flock) as
// long as it is being written.
std::filesystem::path asideIn(const std::filesystem::path& folder);
// Removes what runs that are no more left aside in this folder.
void collectLeftovers(const std::filesystem::path& folder);

// A file descriptor, closed when it goes.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const { return number_; }
  bool isOpen() const { return number_ >= 0; }
  int release() noexcept;

 private:
  int number_;
};

}  // namespace gnomon
