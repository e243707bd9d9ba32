#pragma once
// What a user's bias must not do to the program that runs it: crash the compiler, keep the driver's compiler busy for
// minutes, or never end.

#include "shadow/user_bias.h"

namespace gnomon {

// Compiles the bias in a process of its own (base/child.h), within limits. Throws WorldError that names the file, and
// the line where one is to blame. For before the scene is opened.
void checkUserBias(const UserBias& bias);

// The line, from 1, of a loop that nothing ends: its condition is always true, and it has no break or return. 0: none.
int endlessLoop(const std::string& glsl);

}  // namespace gnomon
