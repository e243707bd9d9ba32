#pragma once
// Where the sources and the build are. Only places.cpp is told: what includes this compiles alike in every checkout,
// and ccache knows it again.

#include <string>

namespace gnomon::test {

// inSource("docs/results.md"), inBuild("gnomon"): absolute paths.
std::string inSource(const std::string& path);
std::string inBuild(const std::string& path);

}  // namespace gnomon::test
