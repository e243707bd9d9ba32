#pragma once
// What the frame pass is measured against: a forward renderer with a cube shadow map and a constant bias, as anybody
// would write it, with none of this project's means. Every face of the cube is one pass over the whole scene that
// writes the distance from the light as depth; the picture is one more pass, with one tap, a texture and a diffuse
// term, into the frame pass's kind of target. Vertices are attributes, textures and cube are sampled.

#include "judge/light_on_map.h"

#include <vector>

namespace gnomon {

class PlainForward {
 public:
  // The light, the cube's size and range, and the exposure are those of `cube`; `offset`: the bias, metres.
  PlainForward(const SceneView& view, const LightOnMap& cube, float offset);

  void recordMap(gpu::Commands& commands) const;
  void recordPicture(gpu::Commands& commands) const;      // a barrier must be before it
  const gpu::Image& picture() const { return picture_; }  // RGBA32F

 private:
  void draw(gpu::Commands& commands, const gpu::GraphicsProgram& program, int face) const;
  void uploadTextures();

  const SceneView& view_;
  gpu::Buffer uniforms_;
  gpu::Image distances_, picture_, pictureDepth_;
  std::vector<gpu::Image> textures_;  // of the scene, and a white one
  gpu::GraphicsProgram drawFace_, drawPicture_;
};

}  // namespace gnomon
