#pragma once
// Maps, receivers and rendered scenes that the tests of shadow/ share.

#include "planar/planar_map.h"
#include "scene/generate.h"
#include "shadow/parameterization.h"
#include "shadow/visibility_pass.h"
#include "tests/gpu_fixture.h"
#include "truth/visibility.h"

#include <random>
#include <vector>

namespace gnomon::test {

// A map of each planar kind, fitted to the generated scene `contact` with side 256.
FittedMap fittedSpot();
FittedMap fittedDirectional();

// A point of the map's volume: the ray through a random uv of a slice, at a random depth. Slices take turns.
struct MapSample {
  int slice;
  glm::vec2 uv;
  float depth;
  glm::vec3 posL;
};
std::vector<MapSample> samplesOf(const FittedMap& fitted, size_t count, uint32_t seed);

// The light ray through a place on a slice, in texels (the centre of texel (x, y) is (x + 0.5, y + 0.5)).
RayD rayThrough(const FittedMap& fitted, int slice, glm::dvec2 place);

// A unit normal that faces the light at posL, at any angle to the ray up to `mostTanAngle`.
glm::vec3 facingNormal(const glm::vec3& rayDir, float tanAngle, float azimuth);

// A scene drawn by its first camera and mapped from its first positional light (or directional, for that kind).
struct Rendered {
  Scene scene;
  std::unique_ptr<Tracer> tracer;
  SceneBuffers buffers;
  glsl::CameraView view;
  std::unique_ptr<GBuffer> gbuffer;
  LightModel light;
  Receivers receivers;
  FittedMap fitted;
  std::unique_ptr<MapRenderer> renderer;  // of the image, and of what draw() draws
  std::unique_ptr<MapImage> image;
};
Rendered render(const gpu::Device& device, const std::string& sceneName, const Parameterization& map, int pictureSide,
                int mapSide, CullMode cull, ChannelSet channels = glsl::kChannelDepth);

// The map of `r` with other channels, or drawn another way.
std::unique_ptr<MapImage> draw(const gpu::Device& device, const Rendered& r, ChannelSet channels, CullMode cull,
                               std::optional<SecondLayer> method = {});

}  // namespace gnomon::test
