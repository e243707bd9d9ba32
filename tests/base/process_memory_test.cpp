// Memory that is freed in the middle of the heap goes back.
#include "base/process_memory.h"
#include "base/sanitizers.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

constexpr size_t kBlocks = 4096, kBlockBytes = 64 << 10;  // below what the allocator maps by itself

TEST(ProcessMemory, WhatIsFreedGoesBack) {
  if (kHasSanitizers) GTEST_SKIP() << "skipped: the sanitizers' allocator keeps what is freed, to watch it";
  FreedMemory freed;
  std::vector<std::unique_ptr<char[]>> blocks(kBlocks);
  for (std::unique_ptr<char[]>& block : blocks) block = std::make_unique<char[]>(kBlockBytes);  // zeroed, so touched
  for (size_t i = 0; i < kBlocks; ++i)
    if (i % 64 != 63) blocks[i].reset();
  const uint64_t before = processMemory().resident;
  EXPECT_GT(before, kBlocks * kBlockBytes / 2);
  for (int i = 0; i < 31; ++i) freed.giveBackNowAndThen();
  EXPECT_GT(processMemory().resident, before / 2);  // it does not look each time
  freed.giveBackNowAndThen();
  EXPECT_LT(processMemory().resident, before / 2);
}

}  // namespace
}  // namespace gnomon
