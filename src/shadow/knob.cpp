#include "shadow/knob.h"

#include <fmt/format.h>

namespace gnomon {

const char* unitName(Unit unit) {
  return unit == Unit::Metres ? "m" : unit == Unit::Texels ? "texels" : "";
}

std::string knobFlag(const char* owner, const Knob& knob) {
  return fmt::format("--{}-{}", owner, knob.name);
}

}  // namespace gnomon
