#include "shadow/occluders.h"

#include "base/check.h"
#include "base/error.h"
#include "base/suggest.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

bool haveSameForm(const FittedMap& a, const FittedMap& b) {
  const bool sourcesAgree = a.occluderSource == nullptr
                                ? b.occluderSource == nullptr
                                : b.occluderSource != nullptr && haveSameForm(*a.occluderSource, *b.occluderSource);
  return sourcesAgree && a.map.kind == b.map.kind && a.map.sliceCount == b.map.sliceCount &&
         a.map.width == b.map.width && a.map.height == b.map.height &&
         a.map.epipolar.alphaCount == b.map.epipolar.alphaCount && a.shaders == b.shaders;
}

}  // namespace

CullMode parseCullMode(const std::string& name) {
  if (name == "solids") return CullMode::Solids;
  if (name == "none") return CullMode::None;
  throw UsageError(fmt::format("--cull {}: no such mode; {}", name, chooseFrom(name, "solids, none")));
}

const char* cullModeName(CullMode mode) {
  return mode == CullMode::Solids ? "solids" : "none";
}

bool Occluders::hasFormOf(const FittedMap& fitted) const {
  return haveSameForm(fitted, fitted_);
}

void Occluders::recordFit(gpu::Commands& commands, const FittedMap& fitted) {
  GNOMON_CHECK(hasFormOf(fitted));
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
