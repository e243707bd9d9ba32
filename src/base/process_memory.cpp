#include "base/process_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace gnomon {

namespace {

constexpr int kLooksAfter = 32;                // pieces of work
constexpr uint64_t kMostGrowth = 64ull << 20;  // bytes

}  // namespace

ProcessMemory processMemory() {
  unsigned long long whole = 0, resident = 0;  // pages
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%llu %llu", &whole, &resident) != 2) whole = resident = 0;
    std::fclose(file);
  }
  const auto page = static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  return {.addressSpace = whole * page, .resident = resident * page};
}

void FreedMemory::giveBackNowAndThen() {
  if (++asked_ % kLooksAfter != 0) return;
  const uint64_t resident = processMemory().resident;
  if (resident < last_ + kMostGrowth) {
    last_ = std::min(last_, resident);
    return;
  }
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  last_ = processMemory().resident;
}

}  // namespace gnomon
