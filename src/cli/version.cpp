#include "cli/version.h"

#include "base/file.h"
#include "lab/results/schema.h"
#include "lab/store/content_hash.h"

#include "build_facts.h"
#include "git_describe.h"

#include <vulkan/vulkan_core.h>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string compilerText() {
#if defined(__clang__)
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

}  // namespace

std::string versionText() {
  const std::string commit = kGitDescribe;
  return fmt::format("gnomon {}{}\nbuilt by {}, {}\nVulkan headers {}.{}.{}\n{}", gnomonVersion(),
                     commit.empty() ? "" : " (" + commit + ")", compilerText(), kBuildType,
                     VK_API_VERSION_MAJOR(VK_HEADER_VERSION_COMPLETE), VK_API_VERSION_MINOR(VK_HEADER_VERSION_COMPLETE),
                     VK_API_VERSION_PATCH(VK_HEADER_VERSION_COMPLETE), kLibraries);
}

std::string programText() {
  std::string commit = kGitDescribe;
  if (commit.ends_with("-dirty")) commit += " " + hashOf(readFile("/proc/self/exe")).substr(0, 8);
  return fmt::format("{}{}", gnomonVersion(), commit.empty() ? "" : " (" + commit + ")");
}

}  // namespace gnomon
