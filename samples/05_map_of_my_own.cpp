// A user-defined parameterization, scored beside the cube: four faces of a tetrahedron around a point light (after
// Liao, "Shadow Mapping for Omni-Directional Light Using Tetrahedron Mapping", GPU Pro, 2010).
//
// Every slice is an ordinary projection (kMapPlanar), so the matrices are all that is needed: biases, filters, labels
// and tables work unchanged. docs/add_a_parameterization.md says what else is needed where no matrix describes the
// texels.
//
//   05_map_of_my_own [SCENE [TEXELS]]      SCENE: a glTF file or the name of a generated scene

#include "lab/compare/table.h"
#include "omni/caster_range.h"
#include "omni/cube_map.h"
#include "planar/window.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace gnomon;

namespace {

// A face is a triangle in the plane at distance 1 before the light: its corners are 2 sqrt(2) from its
// middle, one of them straight up. 1% more than its bounds, so that neighbours overlap by more than a texel.
const Window kFace{.lower = 1.01 * glm::dvec2(-std::sqrt(6.0), -std::sqrt(2.0)),
                   .upper = 1.01 * glm::dvec2(std::sqrt(6.0), 2.0 * std::sqrt(2.0))};

// Vulkan clip space from the light's frame, whose axes are the world's, for the face around the unit vector
// `axis` with a corner towards `corner`.
glm::dmat4 clipFromLight(const glm::dvec3& axis, const glm::dvec3& corner, const DepthEnds& ends) {
  const glm::dvec3 up = glm::normalize(corner - axis * glm::dot(axis, corner));
  const glm::dmat3 planeFromLight = glm::transpose(glm::dmat3(glm::cross(axis, up), up, axis));
  const glm::dmat3 rows = glm::transpose(clipFromPlane(kFace) * planeFromLight);
  const glm::dvec3 depth = axis * (ends.zFar / (ends.zFar - ends.zNear));
  return glm::transpose(glm::dmat4(glm::dvec4(rows[0], 0.0), glm::dvec4(rows[1], 0.0),
                                   glm::dvec4(depth, -ends.zNear * ends.zFar / (ends.zFar - ends.zNear)),
                                   glm::dvec4(axis, 0.0)));
}

class Tetrahedron final : public Parameterization {
 public:
  const char* name() const override { return "tetrahedron"; }
  const char* sentence() const override { return "four slices around a point light"; }
  int sliceCount(const MapOptions&) const override { return 4; }
  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }
  LightModel lightModel(const Light& light, const glm::dvec3&) const override {
    return {.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  }

  FittedMap fit(const FitInput& input) const override {
    DepthEnds ends = fitDepthEnds(input.scene, input.light.positionW, Distance::Radial, input.receiversW);
    ends.zNear *= 0.99 / 3.0;  // a corner is three times as far from the light as the plane: 1 / cos(70.5 degrees)
    FittedMap fitted;
    fitted.frame = {
        .originW = glm::vec3(input.light.positionW), .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}};
    fitted.zNear = static_cast<float>(ends.zNear);
    fitted.zFar = static_cast<float>(ends.zFar);
    fitted.map = {.kind = glsl::kMapPlanar,
                  .sliceCount = 4,
                  .width = input.side,
                  .height = input.side,
                  .sceneScale = computeBounds(input.scene).diagonal()};
    // A face's axis is opposite to one corner of the tetrahedron; its own corners are the three others.
    const glm::dvec3 corners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (int face = 0; face < 4; ++face) {
      const glm::mat4 clip(
          clipFromLight(-corners[face] / std::sqrt(3.0), corners[(face + 1) % 4] / std::sqrt(3.0), ends));
      fitted.map.mapSlices[face] = {clip, glm::mat4(glm::inverse(glm::dmat4(clip)))};
    }
    return fitted;
  }
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Session session({}, {.scene = argc > 1 ? argv[1] : "atrium", .size = "512"});
    const Tetrahedron tetrahedron;
    CompareOptions options;
    options.maps = {&tetrahedron, &cubeParameterization()};
    options.biases = parseBiases("none,constant,adaptive,dual");
    options.mapTexels = argc > 2 ? std::atol(argv[2]) : 6 * 512 * 512;
    const Comparison comparison = compare(session, options);
    std::fputs(comparisonTable(comparison).c_str(), stdout);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
