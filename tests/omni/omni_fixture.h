#pragma once
// A scene with one point light, its maps, and what rays say of every texel.

#include "omni/cube_map.h"
#include "omni_functions.glsl"
#include "scene/gbuffer.h"
#include "scene/generate.h"
#include "shadow/map_image.h"
#include "tests/gpu_fixture.h"
#include "tests/shadow/map_fixture.h"
#include "truth/tracer.h"

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <vector>

namespace gnomon::test {

struct World {
  Scene scene;
  std::unique_ptr<Tracer> tracer;
  SceneBuffers buffers;
  LightModel light;
  std::unique_ptr<MapRenderer> renderer;
};
// With the scene's first light that has a position, or a point light at `lightW`.
World openWorld(const gpu::Device& device, Scene scene, std::optional<glm::dvec3> lightW = {});

// A map of the whole scene: no receivers, so that the far end lies behind every caster.
FittedMap fitWhole(const World& world, const Parameterization& map, int side, const MapOptions& options = {});

struct Slices {
  // Slice after slice; empty where the map has no such channel.
  std::vector<float> z1, z2, zBack;
  std::vector<uint32_t> ids, secondIds;
};
Slices drawSlices(const gpu::Device& device, const World& world, const FittedMap& fitted, CullMode cull,
                  ChannelSet channels = glsl::kChannelDepth, std::optional<SecondLayer> method = {});

// Every held texel against the first hit of its own ray. A texel near an edge of what is seen may hold the
// other side of it.
struct TexelErrors {
  size_t held = 0;          // texels that a slice draws
  size_t covered = 0;       // those whose ray hits something
  size_t atEdges = 0;       // off, within `edgeReach` texels of the edge of a triangle
  size_t off = 0;           // off elsewhere
  double worst = 0.0;       // metres, of `off`
  double worstShare = 0.0;  // of its tolerance, of `off`
};
struct TexelCheck {
  double edgeReach = 0.02;  // texels
  // How far a stored distance may be from the hit's, metres.
  std::function<double(int slice, glm::ivec2 texel, const SurfaceHit& hit)> tolerance;
};
TexelErrors compareWithRays(const World& world, const FittedMap& fitted, const std::vector<float>& depths,
                            const TexelCheck& check);

// By how much the distance to the hit's plane changes, metres, `texels` aside in x and in y.
double distanceChange(const FittedMap& fitted, int slice, glm::ivec2 texel, const SurfaceHit& hit, double texels);

// Unit directions, even over the sphere.
glm::vec3 randomDirection(std::mt19937& random);

// All members of all answers against the CPU's: the worst `apart`, and how many lie in another slice or are covered
// there and not here, whose other members are not compared.
struct RoundTripDifference {
  int64_t worst = 0;
  size_t elsewhere = 0;
};
RoundTripDifference compareRoundTrips(const std::vector<glsl::RoundTrip>& answers,
                                      const std::vector<glsl::RoundTripQuery>& queries, const glsl::ShadowMap& map,
                                      const std::function<int64_t(float, float)>& apart);

}  // namespace gnomon::test
