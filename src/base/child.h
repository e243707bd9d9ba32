#pragma once
// Work on a file that nobody vouches for, done by a library that trusts it: in a process of its own, so that what it
// breaks, fills or never finishes is an error here and nothing else.

#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

struct ChildLimits {
  uint64_t bytes = 0;      // of memory, beyond what this process has; not where sanitizers need the address space
  int seconds = 0;         // of processor time; four times as much by the clock
  bool usesFiles = false;  // else it can neither open nor start nor signal anything (base/sandbox.h)
};

// What `work` returns. It runs in a copy of this process that has no other thread, and may print nothing. Throws what
// `work` throws, as WorldError of the same text; and of limits that are exceeded, or a crash, one that names `name`.
// Whoever trusts no byte of a file trusts none of what is returned either.
std::string runInChild(const std::string& name, const ChildLimits& limits, const std::function<std::string()>& work);

}  // namespace gnomon
