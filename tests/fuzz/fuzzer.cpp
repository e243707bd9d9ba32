#include "fuzzer.h"

#include "base/error.h"
#include "base/message.h"

#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <system_error>

namespace gnomon::test {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "a reader breaks its contract: %s\n", what);
  std::abort();
}

void readOrRefuse(std::string_view name, const std::function<void()>& read) {
  try {
    read();
  } catch (const WorldError& error) {
    const std::string_view message = error.what();
    require(message.starts_with(name) && message.find('\n') == std::string_view::npos, "one line that names the file");
  } catch (const std::bad_alloc&) {  // one line too (main.cpp)
  }
}

const std::filesystem::path& scratchFolder() {
  struct Folder {
    Folder() {
      std::string name = (std::filesystem::temp_directory_path() / "gnomon-fuzz-XXXXXX").string();
      require(::mkdtemp(name.data()) != nullptr, "there is a temporary folder");
      path = name;
    }
    ~Folder() {
      std::error_code failure;
      std::filesystem::remove_all(path, failure);
    }
    std::filesystem::path path;
  };
  static const Folder folder;
  return folder.path;
}

}  // namespace gnomon::test

// What OpenImageIO keeps of its attributes until the program ends; what OpenVDB loses of a tree whose reading throws,
// which the program reads in a process that then ends.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOpenImageIO\nleak:libgnomon_images\nleak:libopenvdb\n";
}
