#pragma once
// See parallel_for.h.

#ifdef GNOMON_ONETBB
#include_next <tbb/parallel_reduce.h>
#else

#include <vector>

#include <tbb/parallel_for.h>

namespace tbb {

template <class Value, class Result, class Body, class Join>
Result parallel_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body, const Join& join) {
  const std::vector<blocked_range<Value> > parts = range.parts();
  std::vector<Result> results(parts.size(), identity);
  gnomonOnThreads(parts.size(), [&](size_t i) { results[i] = body(parts[i], identity); });
  Result all = identity;
  for (const Result& result : results) all = join(all, result);
  return all;
}

}  // namespace tbb

#endif
