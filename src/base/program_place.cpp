#include "base/program_place.h"

#include "base/error.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> libraryFolders() {
  std::vector<fs::path> folders;
  void* own = ::dlopen(nullptr, RTLD_LAZY);
  Dl_serinfo needed{};
  if (own != nullptr && ::dlinfo(own, RTLD_DI_SERINFOSIZE, &needed) == 0) {
    std::vector<std::max_align_t> storage(needed.dls_size / sizeof(std::max_align_t) + 1);
    auto* info = reinterpret_cast<Dl_serinfo*>(storage.data());
    // The second call wants the sizes that the first one found.
    if (::dlinfo(own, RTLD_DI_SERINFOSIZE, info) == 0 && ::dlinfo(own, RTLD_DI_SERINFO, info) == 0)
      for (unsigned i = 0; i < info->dls_cnt; ++i) folders.emplace_back(info->dls_serpath[i].dls_name);
  }
  if (own != nullptr) ::dlclose(own);
  return folders;
}

}  // namespace

std::string findProgram(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  std::vector<fs::path> folders = libraryFolders();
  std::error_code failure;
  folders.push_back(fs::read_symlink("/proc/self/exe", failure).parent_path());
  for (const fs::path& folder : folders)
    if (const fs::path program = folder / name;
        ::access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program, failure))
      return program.string();
  throw fileError(name, "there is no such program",
                  "keep it where the build or the installation put it, or add its folder to LD_LIBRARY_PATH");
}

}  // namespace gnomon
