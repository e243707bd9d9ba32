#include "omni_fixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gnomon::test {

namespace {

bool isNearPrimitiveEdge(const Tracer& tracer, const FittedMap& fitted, int slice, glm::ivec2 texel, double reach) {
  std::optional<Primitive> seen;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 place = glm::dvec2(texel) + 0.5 + reach * glm::dvec2((i & 1) * 2 - 1, (i >> 1) * 2 - 1);
    const auto hit = tracer.firstHit(rayThrough(fitted, slice, place));
    if (!hit || (i > 0 && !(*seen == hit->primitive))) return true;
    seen = hit->primitive;
  }
  return false;
}

}  // namespace

World openWorld(const gpu::Device& device, Scene scene, std::optional<glm::dvec3> lightW) {
  World world;
  world.scene = std::move(scene);
  world.tracer = std::make_unique<Tracer>(world.scene);
  world.buffers = createSceneBuffers(device, world.scene);
  world.renderer = std::make_unique<MapRenderer>(device);
  const auto positional =
      std::ranges::find_if(world.scene.lights, [](const Light& light) { return light.type != LightType::Directional; });
  world.light = {.type = LightType::Point, .positionW = lightW ? *lightW : glm::dvec3(positional->positionW)};
  return world;
}

FittedMap fitWhole(const World& world, const Parameterization& map, int side, const MapOptions& options) {
  const Camera camera =
      world.scene.cameras.empty() ? lookAt("any", {1, 1, 1}, {0, 0, 0}, 1.0f) : world.scene.cameras.front();
  return map.fit({.scene = world.scene,
                  .light = world.light,
                  .receiversW = {},
                  .side = side,
                  .camera = cameraView(camera, 64, 64),
                  .options = options});
}

Slices drawSlices(const gpu::Device& device, const World& world, const FittedMap& fitted, CullMode cull,
                  ChannelSet channels, std::optional<SecondLayer> method) {
  MapImage image(device, fitted, channels, method);
  gpu::Commands commands(device, "shadow map");
  world.renderer->record(commands, world.buffers, image, world.light, cull);
  commands.submitAndWait();
  const auto depthsOf = [&](ChannelSet channel) {
    return (image.channels() & channel) != 0 ? gpu::downloadAs<float>(device, image.image(channel))
                                             : std::vector<float>();
  };
  const auto idsOf = [&](ChannelSet channel) {
    return (image.channels() & channel) != 0 ? gpu::downloadAs<uint32_t>(device, image.image(channel))
                                             : std::vector<uint32_t>();
  };
  const Slices layers{.z1 = depthsOf(glsl::kChannelDepth),
                      .z2 = depthsOf(glsl::kChannelSecondDepth),
                      .zBack = depthsOf(glsl::kChannelBackDepth),
                      .ids = idsOf(glsl::kChannelIds),
                      .secondIds = idsOf(glsl::kChannelSecondIds)};
  return layers;
}

TexelErrors compareWithRays(const World& world, const FittedMap& fitted, const std::vector<float>& depths,
                            const TexelCheck& check) {
  TexelErrors errors;
  const int side = fitted.map.width;
  for (int slice = 0; slice < fitted.map.sliceCount; ++slice) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::ivec2 texel(x, y);
        const float stored = depths[(static_cast<size_t>(slice) * side + y) * side + x];
        if (!glsl::mapHoldsTexel(fitted.map, slice, texel)) {
          if (stored != 1.0f) ++errors.off;
          continue;
        }
        ++errors.held;
        const auto hit = world.tracer->firstHit(rayThrough(fitted, slice, glm::dvec2(texel) + 0.5));
        if (hit) ++errors.covered;
        const glsl::Ray ray = glsl::mapTexelRay(fitted.map, slice, glsl::mapTexelCenter(fitted.map, texel));
        double error = INFINITY, tolerance = 0.0;
        if (!hit && stored == 1.0f) continue;
        if (hit && stored < 1.0f) {
          error = std::abs(static_cast<double>(glsl::mapDistance(fitted.map, slice, ray, stored)) - hit->distance);
          tolerance = check.tolerance(slice, texel, *hit);
          if (error <= tolerance) continue;
        }
        if (isNearPrimitiveEdge(*world.tracer, fitted, slice, texel, check.edgeReach)) {
          ++errors.atEdges;
        } else {
          ++errors.off;
          errors.worst = std::max(errors.worst, error);
          errors.worstShare = std::max(errors.worstShare, error / tolerance);
        }
      }
    }
  }
  return errors;
}

glm::vec3 randomDirection(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const float z = 2.0f * unit(random) - 1.0f;
  const float azimuth = 2.0f * std::numbers::pi_v<float> * unit(random);
  const float r = std::sqrt(std::max(1.0f - z * z, 0.0f));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

double distanceChange(const FittedMap& fitted, int slice, glm::ivec2 texel, const SurfaceHit& hit, double texels) {
  const RayD here = rayThrough(fitted, slice, glm::dvec2(texel) + 0.5);
  double change = 0.0;
  for (const glm::dvec2& aside : {glm::dvec2(texels, 0.0), glm::dvec2(0.0, texels)}) {
    const RayD there = rayThrough(fitted, slice, glm::dvec2(texel) + 0.5 + aside);
    change += std::abs(glm::dot(hit.normalW, here.dir) / glm::dot(hit.normalW, there.dir) - 1.0) * hit.distance;
  }
  return change;
}

RoundTripDifference compareRoundTrips(const std::vector<glsl::RoundTrip>& answers,
                                      const std::vector<glsl::RoundTripQuery>& queries, const glsl::ShadowMap& map,
                                      const std::function<int64_t(float, float)>& apart) {
  RoundTripDifference difference;
  const auto compare = [&](float a, float b) { difference.worst = std::max(difference.worst, apart(a, b)); };
  for (size_t i = 0; i < queries.size(); ++i) {
    const glsl::RoundTrip expected = glsl::roundTrip(map, queries[i]);
    const glsl::RoundTrip& answer = answers[i];
    if (answer.slice != expected.slice || answer.covered != expected.covered ||
        answer.sliceAgain != expected.sliceAgain) {
      ++difference.elsewhere;
      continue;
    }
    for (int c = 0; c < 2; ++c) compare(answer.uv[c], expected.uv[c]);
    for (int c = 0; c < 2; ++c) compare(answer.uvAgain[c], expected.uvAgain[c]);
    for (int c = 0; c < 3; ++c) compare(answer.origin[c], expected.origin[c]);
    for (int c = 0; c < 3; ++c) compare(answer.dir[c], expected.dir[c]);
    compare(answer.depth, expected.depth);
    compare(answer.slope, expected.slope);
    compare(answer.distance, expected.distance);
  }
  return difference;
}

}  // namespace gnomon::test
