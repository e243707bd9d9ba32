#pragma once
// oneTBB's algorithms as Gnomon uses them, on std::thread. ThreadSanitizer sees nothing of what Debian's libtbb does to
// order its threads, and reports every task as a race; these it sees through (tools/races). Files
// that include OpenVDB's headers, which use all of oneTBB, have GNOMON_ONETBB defined and get oneTBB's own.

#ifdef GNOMON_ONETBB
#include_next <tbb/parallel_for.h>
#else

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include <tbb/blocked_range.h>

namespace tbb {

// Calls work(part) for every part of 0 to count, on four threads. Parts are handed out without ordering anything else.
template <class Work>
void gnomonOnThreads(size_t count, const Work& work) {
  std::atomic<size_t> next{0};
  const auto take = [&] {
    for (size_t part = next.fetch_add(1, std::memory_order_relaxed); part < count;
         part = next.fetch_add(1, std::memory_order_relaxed))
      work(part);
  };
  std::vector<std::thread> threads;
  for (size_t i = 0; i < std::min<size_t>(4, count); ++i) threads.emplace_back(take);
  for (std::thread& thread : threads) thread.join();
}

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  if (!(first < last)) return;
  gnomonOnThreads(static_cast<size_t>(last - first), [&](size_t i) { body(static_cast<Index>(first + Index(i))); });
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  const std::vector<blocked_range<Value> > parts = range.parts();
  gnomonOnThreads(parts.size(), [&](size_t i) { body(parts[i]); });
}

}  // namespace tbb

#endif
