#include "omni/cube_map.h"

#include "omni/caster_range.h"

#include <cmath>

namespace gnomon {

constinit const ChoiceOption<CubeDepth> kCubeDepth(
    {.name = "cube_depth", .sentence = "how a cube map stores depth"}, CubeDepth::Hyperbolic,
    {{CubeDepth::Hyperbolic, "hyperbolic", "z/w of each face, as rasterized"},
     {CubeDepth::Radial, "radial", "linear in the distance from the light"}});

constinit const ChoiceOption<SlicePasses> kCubePasses(
    {.name = "cube_passes", .sentence = "how a cube map's faces are drawn"}, SlicePasses::Auto,
    {{SlicePasses::Auto, "auto", "the faster of those that the device draws correctly"},
     {SlicePasses::Each, "six", "one pass a face"},
     {SlicePasses::Multiview, "multiview", "all faces in one pass"}});

namespace {

// z_clip = m * x + y is 0 at m = zNear and m at m = zFar.
glm::vec2 clipDepth(double zNear, double zFar) {
  const double scale = zFar / (zFar - zNear);
  return glm::vec2(glm::dvec2(scale, -zNear * scale));
}

// Rows s, t, m of cubeFaceFromLight, and depth.
glm::mat4 clipFromLight(int slice, const glm::vec2& depth) {
  glm::mat4 m(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 unit(0.0f);
    unit[axis] = 1.0f;
    const glm::vec3 stm = glsl::cubeFaceFromLight(slice, unit);
    m[axis] = {stm.x, stm.y, stm.z * depth.x, stm.z};
  }
  m[3] = {0.0f, 0.0f, depth.y, 0.0f};
  return m;
}

class CubeParameterization final : public Parameterization {
 public:
  const char* name() const override { return "cube"; }
  const char* sentence() const override { return "six faces around a point light"; }
  int sliceCount(const MapOptions&) const override { return 6; }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }

  LightModel lightModel(const Light& light, const glm::dvec3&) const override {
    return {.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  }

  FittedMap fit(const FitInput& input) const override {
    const CubeDepth depth = input.options.get(kCubeDepth);
    const DepthEnds ends = chosenDepthEnds(input, depth == CubeDepth::Radial ? Distance::Radial : Distance::Axial);
    FittedMap fitted = makeCubeMap(input.light.positionW, depth, ends.zNear, ends.zFar, input.side,
                                   computeBounds(input.scene).diagonal());
    fitted.shaders.passes = input.options.get(kCubePasses);
    return fitted;
  }

  std::vector<const MapOption*> options() const override { return {&kCubeDepth, &kCubePasses, &kDepthRange}; }
  std::vector<Variant> variants(const MapOptions& given) const override {
    return {{"radial", given.with(kCubeDepth(CubeDepth::Radial))}};
  }
  bool looksAround() const override { return true; }
};

}  // namespace

const Parameterization& cubeParameterization() {
  static const CubeParameterization cube;
  return cube;
}

FittedMap makeCubeMap(const glm::dvec3& lightW, CubeDepth depth, double zNear, double zFar, int side,
                      float sceneScale) {
  const bool radial = depth == CubeDepth::Radial;
  FittedMap fitted;
  fitted.frame = {.originW = glm::vec3(lightW), .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}};
  fitted.zNear = static_cast<float>(zNear);
  fitted.zFar = static_cast<float>(zFar);
  fitted.map = {.kind = radial ? glsl::kMapCubeRadial : glsl::kMapCube,
                .sliceCount = 6,
                .width = side,
                .height = side,
                .sceneScale = sceneScale,
                .zNear = fitted.zNear,
                .zFar = fitted.zFar};
  // What lies within the near distance is moved to it by the fragment shader; the near plane must only not
  // cut what lies beyond. A hundredth keeps it clear of rounding.
  fitted.map.clipDepth = clipDepth(radial ? zNear * (0.99 / std::sqrt(3.0)) : zNear, zFar);
  for (int slice = 0; slice < 6; ++slice) {
    const glm::mat4 clip = clipFromLight(slice, fitted.map.clipDepth);
    fitted.map.mapSlices[slice] = {clip, glm::mat4(glm::inverse(glm::dmat4(clip)))};
  }
  fitted.shaders.mirroredSlices = 0x3f;
  // A cross: +X -X +Y -Y +Z -Z
  fitted.unfoldedAt = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  if (radial) {
    fitted.shaders.fragment = "omni/draw_cube_radial.frag.glsl";
    fitted.shaders.rasterizedDepth = false;
  }
  return fitted;
}

}  // namespace gnomon
