#include "tests/base/places.h"

namespace gnomon::test {

std::string inSource(const std::string& path) {
  return GNOMON_SOURCE_DIR "/" + path;
}

std::string inBuild(const std::string& path) {
  return GNOMON_BUILD_DIR "/" + path;
}

}  // namespace gnomon::test
