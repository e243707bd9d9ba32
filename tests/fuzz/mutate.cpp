// Damaged files by the ten thousand, to every reader that Gnomon has; run by tools/mutate under sanitizers.
//
//   mutate KIND COUNT FOLDER SEED...     KIND: gltf, image, results, bias, shader, density, plan
//
// Number n is always the same: `mutate --one KIND n FOLDER SEED...` repeats it, and prints the refusal. Each must give
// what the reader promises or a WorldError of one line, within 10 s of processor time; the input that does not is left
// in FOLDER, and its number on stderr.

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/message.h"
#include "lab/page/report.h"
#include "lab/sweep/axes.h"
#include "scene/gltf.h"
#include "shadow/user_bias_check.h"
#include "vsv/media/density.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace gnomon;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMostSeconds = 10;             // of processor time, as a busy machine gives it late
constexpr unsigned kMostClockSeconds = 120;  // for what waits

std::string current;  // for the signal handler

void onAlarm(int) {
  const std::string text = "takes more than 10 s: " + current + "\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
  std::abort();
}

class Mutator {
 public:
  explicit Mutator(const std::vector<std::string>& seeds) : seeds_(seeds) {}

  std::string make(uint64_t number) {
    random_.seed(number);
    std::string bytes = seeds_[below(seeds_.size())];
    for (size_t changes = 1 + below(4); changes > 0; --changes) change(bytes);
    return bytes;
  }

 private:
  size_t below(size_t count) { return static_cast<size_t>(random_() % std::max<size_t>(count, 1)); }

  void put(std::string& bytes, size_t at, const std::string& what) {
    bytes.replace(at, std::min(what.size(), bytes.size() - at), what);
  }

  void change(std::string& bytes) {
    const size_t at = below(bytes.size()), length = 1 + below(16);
    switch (below(9)) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        if (!bytes.empty()) bytes[at] = static_cast<char>(random_());
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:  // again, perhaps many times
        for (size_t n = below(3) == 0 ? below(2000) : 1; n > 0; --n) bytes.insert(at, bytes.substr(at, length));
        break;
      case 5: {  // numbers at which sizes go wrong
        static const uint64_t kNumbers[] = {0,          1,          0x7f,       0x80,       0xff,         0x7fff,
                                            0xffff,     0x7fffffff, 0x80000000, 0xffffffff, 0xffffffffff, ~uint64_t{0},
                                            0x7f800000, 0x7fc00000, 1ull << 63};
        const uint64_t value = kNumbers[below(std::size(kNumbers))];
        put(bytes, at, std::string(reinterpret_cast<const char*>(&value), below(2) == 0 ? 4 : 8));
        break;
      }
      case 6: {
        static const char* const kWords[] = {"-1",      "1e999", "99999999999", "null",       "[]",   "{}",
                                             "\"\"",    "NaN",   "[[[[",        "4294967296", "-0.0", "\\u0000",
                                             "\x1b[2J", "\n",    "\xff\xfe",    "true"};
        bytes.insert(at, kWords[below(std::size(kWords))]);
        break;
      }
      case 7: {
        const std::string& other = seeds_[below(seeds_.size())];
        bytes = bytes.substr(0, at) + other.substr(below(other.size()));
        break;
      }
      default: {  // a number in text
        const size_t digit = bytes.find_first_of("0123456789", at);
        if (digit != std::string::npos) bytes.replace(digit, 1, std::to_string(random_() >> below(64)));
      }
    }
  }

  const std::vector<std::string>& seeds_;
  std::mt19937_64 random_;
};

void readScene(const std::string& bytes, const fs::path&) {
  const Scene scene = loadGltfFromMemory(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), "m.gltf");
  if (!std::isfinite(computeBounds(scene).diagonal())) throw std::runtime_error("bounds that are not finite");
}

void readPicture(const std::string& bytes, const fs::path&) {
  const Image8 image = decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "m.png");
  if (image.values.size() != 4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height))
    throw std::runtime_error("an image of another size than it says");
}

void readFolder(const std::string& bytes, const fs::path& folder) {
  writeTextFile(folder / "results.json", bytes);
  if (reportHtml(folder).find("</html>") == std::string::npos) throw std::runtime_error("half a page");
}

void readBiasText(const std::string& bytes, const fs::path&) {
  readUserBias("m.glsl", bytes);
  endlessLoop(bytes);
}

void compileBias(const std::string& bytes, const fs::path&) {
  checkUserBias(*readUserBias("m.glsl", bytes));
}

void readDensity(const std::string& bytes, const fs::path& folder) {
  writeTextFile(folder / "m.vdb", bytes);
  const std::string named = bytes.size() % 4 == 0 ? "" : ":density";
  const DensityGrid grid((folder / "m.vdb").string() + named, {});
  grid.at(glm::dvec3(grid.boundsW().lower));
  grid.at(0.5 * glm::dvec3(grid.boundsW().lower + grid.boundsW().upper));
}

void readPlanText(const std::string& bytes, const fs::path& folder) {
  axesOf(parsePlan(folder / "m.json", bytes));
}

using Read = void (*)(const std::string& bytes, const fs::path& folder);

Read readerOf(const std::string& kind) {
  static const std::pair<const char*, Read> kReaders[] = {
      {"gltf", readScene},     {"image", readPicture},   {"results", readFolder}, {"bias", readBiasText},
      {"shader", compileBias}, {"density", readDensity}, {"plan", readPlanText}};
  for (const auto& [name, read] : kReaders)
    if (kind == name) return read;
  std::fprintf(stderr, "no such kind: %s\n", kind.c_str());
  std::exit(2);
}

// Empty where all is well.
std::string complaintAbout(Read read, const std::string& bytes, const fs::path& folder, uint64_t& refused,
                           bool prints) {
  try {
    read(bytes, folder);
  } catch (const WorldError& error) {
    ++refused;
    const std::string shown = oneLine(error.what());
    if (prints) fmt::print("{}\n", shown);
    if (shown.size() > kLongestMessage || printable(shown) != shown) return "a message of more than a line: " + shown;
  } catch (const std::exception& error) {
    return std::string("an error that is not the world's: ") + error.what();
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  const bool one = argc > 1 && std::string(argv[1]) == "--one";
  if (argc < (one ? 6 : 5)) {
    std::fprintf(stderr, "mutate [--one] KIND COUNT FOLDER SEED...\n");
    return 2;
  }
  char** words = argv + (one ? 2 : 1);
  const Read read = readerOf(words[0]);
  const uint64_t count = std::strtoull(words[1], nullptr, 10);
  const fs::path folder = words[2];
  std::vector<std::string> seeds;
  for (char** seed = words + 3; *seed != nullptr; ++seed) seeds.push_back(readFile(*seed));
  Mutator mutator(seeds);
  for (const int signal : {SIGALRM, SIGPROF}) std::signal(signal, onAlarm);
  uint64_t refused = 0;
  double slowest = 0.0;
  for (uint64_t number = one ? count : 0; number < count + (one ? 1 : 0); ++number) {
    const std::string bytes = mutator.make(number);
    current = fmt::format("{} {}", words[0], number);
    const itimerval processorTime{.it_interval = {}, .it_value = {.tv_sec = kMostSeconds, .tv_usec = 0}};
    ::setitimer(ITIMER_PROF, &processorTime, nullptr);
    ::alarm(kMostClockSeconds);
    const Clock::time_point begin = Clock::now();
    // Before it is read, so that a crash leaves it.
    if (one) writeTextFile(folder / "input", bytes);
    const std::string complaint = complaintAbout(read, bytes, folder, refused, one);
    slowest = std::max(slowest, std::chrono::duration<double>(Clock::now() - begin).count());
    if (complaint.empty()) continue;
    writeTextFile(folder / fmt::format("{}-{}", words[0], number), bytes);
    std::fprintf(stderr, "%s: %s\n", current.c_str(), complaint.c_str());
    return 1;
  }
  rusage usage{}, children{};
  ::getrusage(RUSAGE_SELF, &usage);
  ::getrusage(RUSAGE_CHILDREN, &children);
  fmt::print("{:<8} {:>6} inputs: {} refused, slowest {:.2f} s, at most {} MiB\n", words[0], count, refused, slowest,
             std::max(usage.ru_maxrss, children.ru_maxrss) >> 10);
  return 0;
}
