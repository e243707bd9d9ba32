#pragma once
// See parallel_for.h.

#ifdef GNOMON_ONETBB
#include_next <tbb/task_arena.h>
#else

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int) {}
  template <class Work>
  auto execute(const Work& work) {
    return work();
  }
};

}  // namespace tbb

#endif
