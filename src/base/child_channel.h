#pragma once
// What runInChild and runAsChild (base/child.h) agree upon. The program's words are the work's name, its limits
// ("BYTES SECONDS USES_FILES PARENT"), and the arguments.

#include <string>
#include <string_view>

namespace gnomon {

// The child's descriptors behind the standard ones, which go nowhere. It ends when it closes the last of them.
inline constexpr int kChildInput = 3, kChildResult = 4, kChildHeld = 5, kChildDescriptors = 6;

// The first byte of the result. It says `Begun` from when the program begins, so that what ends before is told apart.
enum class ChildOutcome : char { Begun = 'B', Done = 'D', Failed = 'F', OutOfMemory = 'M' };

bool writeAll(int descriptor, std::string_view bytes);
// Of a file, from its beginning.
std::string readAll(int descriptor);

}  // namespace gnomon
