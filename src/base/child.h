#pragma once
// Work on a file that nobody vouches for, done by a library that trusts it: in a process of its own, so that what it
// breaks, fills or never finishes is an error here and nothing else.
//
// That process runs a program of its own, too (src/child), not a copy of this one: in a copy, a lock that another
// thread held at that moment is held for ever, be it of the allocator, of the compiler or of the loader.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon {

struct ChildLimits {
  uint64_t bytes = 0;      // of memory, beyond what the program begins with; not where sanitizers need the addresses
  int seconds = 0;         // of processor time; four times as much by the clock
  bool usesFiles = false;  // else it can neither open nor start nor signal anything (base/sandbox.h)
};

struct ChildWork {
  std::string file;                    // what it is about, for complaints
  std::string name;                    // one of those that the program has
  std::vector<std::string> arguments;  // without zero bytes
  std::string_view input = {};
  int inputFile = -1;   // in place of `input`: a regular file, read from its beginning
  std::string program;  // by its path, or looked for as findProgram (base/program_place.h) does
};

// What the work returns. Throws what it throws, as WorldError of the same text; of limits that are exceeded, or a
// crash, one that names the file; and Interrupted (base/interrupt.h). Whoever trusts no byte of a file trusts none of
// what is returned either.
std::string runInChild(const ChildWork& work, const ChildLimits& limits);

// For the program itself: its works by their names, of which it does the one that it was started for. It may print
// nothing. Returns the exit code.
using ChildFunction = std::string (*)(const std::vector<std::string>& arguments, std::string input);
int runAsChild(int argc, char** argv, std::initializer_list<std::pair<std::string_view, ChildFunction>> works);

}  // namespace gnomon
