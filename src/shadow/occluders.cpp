#include "shadow/occluders.h"

#include "base/error.h"
#include "base/suggest.h"

#include <fmt/format.h>

namespace gnomon {

CullMode parseCullMode(const std::string& name) {
  if (name == "solids") return CullMode::Solids;
  if (name == "none") return CullMode::None;
  throw UsageError(fmt::format("--cull {}: no such mode; {}", name, chooseFrom(name, "solids, none")));
}

const char* cullModeName(CullMode mode) {
  return mode == CullMode::Solids ? "solids" : "none";
}

Occluders::Occluders(const gpu::Device& device, const FittedMap& fitted, const char* uniformsName)
    : fitted_(fitted),
      uniforms_(gpu::createBufferWith(
          device, uniformsName, std::vector<glsl::MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)) {}

}  // namespace gnomon
