#pragma once
// What a user's bias must not do to the program that runs it: crash the compiler, keep the driver's compiler busy for
// minutes, or never end.

#include "shadow/user_bias.h"

#include <string>
#include <vector>

namespace gnomon {

// Compiles the bias in a process of its own (base/child.h), within limits; a text that has passed, not again. Throws
// WorldError that names the file, and the line where one is to blame. For before the scene is opened.
void checkUserBias(const UserBias& bias);

// The line, from 1, of a loop that nothing ends: its condition is always true, and it has no break or return. 0: none.
int endlessLoop(const std::string& glsl);

// What checkUserBias has done in the process of its own (src/child). Arguments: the folder of shaders, empty for the
// embedded ones, and the bias's path. Returns "VALUES INSTRUCTIONS": of its largest type, and of all its functions
// written out at every call.
inline constexpr const char* kUserBiasWork = "user-bias";
std::string compiledUserBias(const std::vector<std::string>& arguments, std::string source);

}  // namespace gnomon
