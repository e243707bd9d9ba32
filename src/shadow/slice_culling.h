#pragma once
// Culling for a map's slices: whole draws, and the parts that SceneBuffers cuts large draws into. Conservative: nothing
// that a slice shows is left out.

#include "scene/scene_buffers.h"
#include "shadow/parameterization.h"

#include <vector>

namespace gnomon {

class SliceCulling {
 public:
  // For slices first .. first + count - 1 together: projective ones, which have four sides, or half spaces
  // (FittedMap::halfSpaces). Others may show everything.
  SliceCulling(const FittedMap& fitted, int first, int count);

  bool mayShow(const Bounds& boundsW) const;

  struct Range {
    uint32_t firstIndex = 0, indexCount = 0;
  };
  // Of a draw's triangles in their order, neighbouring parts as one range.
  std::vector<Range> rangesOf(const SceneBuffers& scene, const Draw& draw) const;

 private:
  // Rows x, y and w of clip space, as functions of a point in the light's frame and in the world (but for a constant).
  struct Projective {
    glm::vec4 fromLight[3];
    glm::vec3 fromWorld[3];
    bool mayShow(const glm::vec3& centerL, const glm::vec3& halfSizeW) const;
  };
  struct Hemisphere {
    float axisZ;      // of L: +1 or -1
    glm::vec3 backW;  // L's z
    float beyondRim;  // how far behind the light it shows, over the distance
    bool mayShow(const glm::vec3& centerL, const glm::vec3& halfSizeW) const;
  };

  glsl::LightFrame frame_;
  std::vector<Projective> projective_;
  std::vector<Hemisphere> hemispheres_;
};

}  // namespace gnomon
