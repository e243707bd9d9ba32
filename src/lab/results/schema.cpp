#include "lab/results/schema.h"

#include <fmt/format.h>

namespace gnomon {

const char* gnomonVersion() {
  return GNOMON_VERSION;
}

double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

}  // namespace gnomon
