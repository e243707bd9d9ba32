// Every format on a disk that is full after every possible number of bytes; run by tools/full_disks.
//
//   every_byte FOLDER RESULT     RESULT: what gnomon compare -o wrote
//
// The kernel's limit on a file's size (RLIMIT_FSIZE) stands for the disk: the write that reaches it is cut there, and
// the next one fails. Whatever the count, the writer must throw, and the old file be there alone and as it was. A file
// of more than kWhole bytes is tried at counts near its two ends and around each page alone: between those, every count
// cuts the same call of write(2) in two, as its neighbours do.

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "lab/page/report.h"
#include "scene/generate.h"
#include "scene/gltf.h"
#include "vsv/media/generate_density.h"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>

#include <fmt/format.h>

namespace {

using namespace gnomon;
namespace fs = std::filesystem;

constexpr uint64_t kWhole = 1 << 16, kPage = 4096, kEnd = 512, kNear = 1;

void setLimit(rlim_t bytes) {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = std::min(bytes, limit.rlim_max);
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

bool isTried(uint64_t bytes, uint64_t size) {
  const uint64_t inPage = bytes % kPage;
  return size <= kWhole || bytes < kEnd || bytes + kEnd >= size || inPage <= kNear || inPage + kNear >= kPage;
}

using Write = std::function<void(const fs::path&)>;

// Empty where it is well.
std::string complaintAt(uint64_t bytes, const fs::path& path, const Write& write) {
  setLimit(bytes);
  bool threw = false;
  try {
    write(path);
  } catch (const WorldError&) {
    threw = true;
  }
  setLimit(RLIM_INFINITY);
  if (!threw) return "is written, and nothing is thrown";
  if (readFile(path) != "old") return "the old file is not as it was";
  if (std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()) != 1)
    return "something is left beside the old file";
  return "";
}

int tryFormat(const fs::path& path, const Write& write) {
  write(path);
  const uint64_t size = fs::file_size(path);
  writeTextFile(path, "old");
  uint64_t tried = 0;
  int failures = 0;
  for (uint64_t bytes = 0; bytes < size; ++bytes) {
    if (!isTried(bytes, size)) continue;
    ++tried;
    const std::string complaint = complaintAt(bytes, path, write);
    if (complaint.empty()) continue;
    ++failures;
    fmt::print(stderr, "{}, {} of {} bytes: {}\n", path.filename().string(), bytes, size, complaint);
    writeTextFile(path, "old");
  }
  setLimit(size);
  write(path);
  setLimit(RLIM_INFINITY);
  if (fs::file_size(path) != size) ++failures;
  fs::remove(path);
  fmt::print("{:<12} {:>7} bytes: {} of {} byte counts tried; {} failures\n", path.filename().string(), size, tried,
             size, failures);
  std::fflush(stdout);
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "every_byte FOLDER RESULT\n");
    return 2;
  }
  std::signal(SIGXFSZ, SIG_IGN);
  const fs::path folder = argv[1];
  const std::string json = readFile(fs::path(argv[2]) / "results.json"), page = reportHtml(argv[2]);
  Image8 picture(64, 64, 4);
  for (size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = static_cast<uint8_t>(i * i >> 5);
  ImageF data(16, 16, 1);
  for (size_t i = 0; i < data.values.size(); ++i) data.values[i] = 0.1f * static_cast<float>(i);
  const Scene scene = openScene("corner");
  int failures = 0;
  failures += tryFormat(folder / "a.png", [&](const fs::path& path) { writePng(path, picture); });
  failures += tryFormat(folder / "a.exr",
                        [&](const fs::path& path) { writeExr(path, data, {.names = {"Y"}, .units = "metres"}); });
  failures += tryFormat(folder / "a.glb", [&](const fs::path& path) { saveGlb(scene, path); });
  failures += tryFormat(folder / "a.json", [&](const fs::path& path) { writeTextFile(path, json); });
  failures += tryFormat(folder / "a.html", [&](const fs::path& path) { writeTextFile(path, page); });
  failures += tryFormat(folder / "a.vdb", [&](const fs::path& path) {
    writeGeneratedDensity("puff", {.lower = glm::vec3(0.0f), .upper = glm::vec3(1.0f)}, 1, path);
  });
  return failures == 0 ? 0 : 1;
}
