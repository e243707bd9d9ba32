#pragma once
// See parallel_for.h. What it limits, the results do not depend on.

#ifdef GNOMON_ONETBB
#include_next <tbb/global_control.h>
#else

#include <cstddef>

namespace tbb {

class global_control {
 public:
  enum Parameter { max_allowed_parallelism };
  global_control(Parameter, size_t) {}
};

}  // namespace tbb

#endif
