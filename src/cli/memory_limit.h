#pragma once
// Runs under a limit on the address space (ulimit -v). Drivers and libraries crash, abort or print what they like where
// memory ends; so the work is then done in a child, and what a person gets is one line.

#include <functional>

namespace gnomon {

bool isMemoryLimited();

// The exit code of `work`, which prints its own errors; 1 and a line about memory where it ends in another way.
int runWithinMemoryLimit(const std::function<int()>& work);

}  // namespace gnomon
