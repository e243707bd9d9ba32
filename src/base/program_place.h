#pragma once
// Programs that Gnomon starts or becomes.

#include <string>

namespace gnomon {

// Where a program of that name is: in the folders where libraries are looked for at run time (the RUNPATH of the
// program that runs, which the build and the installation set, and LD_LIBRARY_PATH) or beside the program that runs. A
// name with a slash is a path already. Throws WorldError where there is none.
std::string findProgram(const std::string& name);

}  // namespace gnomon
