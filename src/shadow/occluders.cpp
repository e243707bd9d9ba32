#include "shadow/occluders.h"

#include "base/check.h"
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

void Occluders::recordFit(gpu::Commands& commands, const FittedMap& fitted) {
  GNOMON_CHECK_EQ(fitted.map.kind, fitted_.map.kind);
  GNOMON_CHECK_EQ(fitted.map.sliceCount, fitted_.map.sliceCount);
  GNOMON_CHECK_EQ(fitted.map.width, fitted_.map.width);
  GNOMON_CHECK_EQ(fitted.map.height, fitted_.map.height);
  GNOMON_CHECK(fitted.shaders == fitted_.shaders);
  fitted_ = fitted;
  const glsl::MapUniforms uniforms{.lightFrame = fitted.frame, .shadowMap = fitted.map};
  commands.update(uniforms_, gpu::asPush(uniforms));
  commands.barrier("the map's numbers are written -> drawing and look-ups read them");
}

Occluders::Occluders(const gpu::Device& device, const FittedMap& fitted, const char* uniformsName)
    : fitted_(fitted),
      uniforms_(gpu::createBufferWith(
          device, uniformsName, std::vector<glsl::MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)) {}

}  // namespace gnomon
