#pragma once
// What of the program determines a case's counts, as a sweep's keys have it. Commits that change none of it leave a
// store as it is.

#include <string>
#include <string_view>

namespace gnomon {

// One more with every change outside the shaders that changes a count: how a map is fitted, what is traced, what is
// scored. The test Sweep.CountsChangeOnlyWithTheirVersion sees where it was forgotten.
inline constexpr int kCountsVersion = 1;

// "1-0a1b2c3d4e5f6071": kCountsVersion, and a hash of the shaders with the shared mathematics, comments and blanks
// aside.
std::string resultsVersion();

// A GLSL text without comments, runs of blanks as one; ends of lines stay, which end directives.
std::string withoutComments(std::string_view glsl);

}  // namespace gnomon
