#pragma once
// See parallel_for.h.

#ifdef GNOMON_ONETBB
#include_next <tbb/blocked_range.h>
#else

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tbb {

template <class Value>
class blocked_range {
 public:
  blocked_range(Value begin, Value end, size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  size_t size() const { return static_cast<size_t>(end_ - begin_); }
  bool empty() const { return !(begin_ < end_); }

  std::vector<blocked_range> parts() const {
    std::vector<blocked_range> result;
    const auto step = static_cast<Value>(std::max(grain_, size_t{1}));
    for (Value at = begin_; at < end_;
         at = static_cast<Value>(at + std::min<Value>(step, static_cast<Value>(end_ - at))))
      result.emplace_back(at, static_cast<Value>(at + std::min<Value>(step, static_cast<Value>(end_ - at))), grain_);
    return result;
  }

 private:
  Value begin_, end_;
  size_t grain_;
};

}  // namespace tbb

#endif
