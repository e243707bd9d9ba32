#pragma once
// What a person reads of a run. It goes to standard output, or to standard error where standard output carries a file
// (an output named "-"). What is lost on the way is an error.

#include <string_view>

namespace gnomon {

// Opens whichever of the three standard streams is closed, so that no file takes its place and no table goes into it.
void guardStandardStreams();

void say(std::string_view text);
// From now on `say` goes to standard error.
void giveStandardOutputAway();

// Throws WorldError where anything written to standard output was lost.
void finishStandardOutput();

}  // namespace gnomon
