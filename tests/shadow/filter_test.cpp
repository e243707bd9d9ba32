// shared/filter.glsl: kernels that are what they say, the same taps on both processors, and the visibility
// shader end to end against a sum over the map's own texels.
#include "base/error.h"
#include "filter_functions.glsl"
#include "map_fixture.h"
#include "tests/run_kernel.h"

#include "shared/bias.glsl"

#include <algorithm>
#include <cmath>
#include <set>

namespace gnomon {
namespace {

using namespace glsl;

// Of a filter of the list.
FilterTap knownTap(const ChosenFilter& filter, glm::vec2 position, uint seed, int i) {
  bool known = false;
  const FilterTap tap = filterTap(filter.id, filter.params, position, seed, i, known);
  EXPECT_TRUE(known);
  return tap;
}

glm::vec2 knownOffset(const ChosenFilter& filter, uint seed, int i) {
  bool known = false;
  const glm::vec2 offset = kernelOffset(filter.id, filter.params, seed, i, known);
  EXPECT_TRUE(known);
  return offset;
}

ChosenFilter jitterOfWidth(float width) {
  ChosenFilter filter = kShadowFilterJitter4x4;
  filter.params.knobs[kJitterWidth] = width;
  return filter;
}

TEST(Filter, WeightsAddUpToOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const Filter& listed : filters()) {
    const ChosenFilter filter = listed.id;
    for (int n = 0; n < 1000; ++n) {
      const glm::vec2 position(unit(random) * 512.0f, unit(random) * 512.0f);
      float sum = 0.0f;
      for (int i = 0; i < filter.tapCount; ++i) {
        const float weight = knownTap(filter, position, 7u, i).weight;
        EXPECT_TRUE(weight >= 0.0f && weight <= 1.0f) << listed.name << " " << weight;
        sum += weight;
      }
      EXPECT_NEAR(sum, 1.0f, 2e-7f) << listed.name;
    }
  }
}

// A bilinear filter of the texels' own coordinates gives the position back.
TEST(Filter, BilinearReproducesALinearFunction) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int n = 0; n < 1000; ++n) {
    const glm::vec2 position(unit(random) * 512.0f, unit(random) * 512.0f);
    glm::vec2 sum(0.0f);
    for (int i = 0; i < 4; ++i) {
      const FilterTap tap = knownTap(kShadowFilterBilinear, position, 0u, i);
      sum += (glm::vec2(tap.texel) + 0.5f) * tap.weight;
    }
    EXPECT_NEAR(sum.x, position.x, 1e-4f);  // 512 texels in floats: an ulp is 3e-5
    EXPECT_NEAR(sum.y, position.y, 1e-4f);
  }
}

// A cell is a quarter of the square's side.
TEST(Filter, JitterHasOnePointInEachCell) {
  for (const float width : {4.0f, 1.0f, 16.0f}) {
    const ChosenFilter filter = jitterOfWidth(width);
    for (uint seed = 0; seed < 200; ++seed) {
      std::set<std::pair<int, int>> cells;
      for (int i = 0; i < 16; ++i) {
        const glm::vec2 offset = jitterOffset(filter.params, hashOf(seed), i) * (4.0f / width);
        cells.emplace(static_cast<int>(std::floor(offset.x)), static_cast<int>(std::floor(offset.y)));
        EXPECT_GE(std::min(offset.x, offset.y), -2.0f);
        EXPECT_LT(std::max(offset.x, offset.y), 2.0f);
      }
      EXPECT_EQ(cells.size(), 16u) << width;
    }
  }
}

// Mean and variance: a square of a width has its square over 12, a tent of half width 1 has 1/6.
TEST(Filter, ExactKernelsHaveTheirMoments) {
  for (const auto& [filter, variance] : {std::pair<ChosenFilter, double>(kShadowFilterJitter4x4, 16.0 / 12.0),
                                         {jitterOfWidth(6.0f), 36.0 / 12.0},
                                         {kShadowFilterBilinear, 1.0 / 6.0}}) {
    double mean = 0.0, square = 0.0;
    constexpr int kPixels = 4000;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      for (int i = 0; i < kKernelSamples; ++i) {
        const glm::vec2 offset = knownOffset(filter, pixelSeed({pixel, 3}), i);
        mean += static_cast<double>(offset.x + offset.y) / (2.0 * kPixels * kKernelSamples);
        square += static_cast<double>(glm::dot(offset, offset)) / (2.0 * kPixels * kKernelSamples);
      }
    }
    // 128,000 values, stratified: the standard error is below sqrt(variance / 128000).
    EXPECT_NEAR(mean, 0.0, 4.0 * std::sqrt(variance / 128000.0)) << filter.id;
    EXPECT_NEAR(square, variance, 0.02 * variance) << filter.id;
  }
}

TEST(Filter, EveryIdOfTheListIsKnownAndAnotherIsTold) {
  std::set<int> ids;
  for (const Filter& filter : filters()) {
    EXPECT_TRUE(ids.insert(filter.id).second) << filter.name;
    EXPECT_LE(std::ssize(filter.knobs), kMostFilterKnobs) << filter.name;
    knownTap(filter.id, {1.5f, 2.5f}, 1u, 0);
    knownOffset(filter.id, 1u, 0);
  }
  bool known = true;
  filterTap(999, {}, {1.5f, 2.5f}, 1u, 0, known);
  EXPECT_FALSE(known);
  known = true;
  kernelOffset(999, {}, 1u, 0, known);
  EXPECT_FALSE(known);
}

TEST(Filter, NamesAreListedWhenOneIsWrong) {
  EXPECT_EQ(parseFilters("all").size(), filters().size());
  EXPECT_EQ(parseFilters("bilinear,none,bilinear").size(), 2u);
  EXPECT_THROW(parseFilters(""), UsageError);
  try {
    parseFilters("billinear");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("billinear: no such filter; did you mean bilinear? Choose from none, bilinear, jitter4x4"),
              std::string::npos)
        << error.what();
  }
}

class FilterOnTheGpu : public gpu::GpuTest {};

TEST_F(FilterOnTheGpu, TapsAndKernelsEqualTheCpu) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<FilterQuery> queries(gpu::kKernelInputCount);
  for (FilterQuery& query : queries) {
    const ChosenFilter filter = filters()[random() % filters().size()].id;
    query.kind = random() % 64 == 0 ? 999 : filter.id;
    query.params = filter.params;
    for (float& knob : query.params.knobs) knob *= 0.5f + unit(random);
    query.position = {unit(random) * 1024.0f, unit(random) * 1024.0f};
    query.pixel = {static_cast<int>(random() % 4096), static_cast<int>(random() % 4096)};
    query.i = static_cast<int>(random() % 16) % filter.tapCount;
  }
  const auto answers =
      gpu::runKernel<FilterQuery, FilterAnswer>(device(), GNOMON_TEST_SHADER("evaluate_filter.comp.glsl"), queries);
  size_t different = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const FilterAnswer cpu = answerFilter(queries[i]);
    const auto differ = [&](float a, float b) { return apart(a, b) > apartAtMost(); };
    different += cpu.texel != answers[i].texel || differ(cpu.weight, answers[i].weight) ||
                 differ(cpu.kernel.x, answers[i].kernel.x) || differ(cpu.kernel.y, answers[i].kernel.y) ||
                 cpu.known != answers[i].known;
  }
  EXPECT_LE(different, isLavapipe() ? size_t{0} : queries.size() / 1000);
}

// What the pass says of a pixel is what its taps say on the CPU, of the depths that the map holds.
TEST_F(FilterOnTheGpu, TheVisibilityPassIsTheSumOfItsTaps) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 64, CullMode::Solids);
  for (const char* name : {"adaptive", "dual", "constant", "normal-offset"}) {
    const BiasMethod& method = findBias(name);
    const auto image = test::draw(device(), r, method.channels, CullMode::Solids);
    const auto depth = gpu::downloadAs<float>(device(), image->depth());
    const bool two = (method.channels & kChannelSecondDepth) != 0;
    const auto second = two ? gpu::downloadAs<float>(device(), image->secondDepth()) : std::vector<float>();
    const BiasParams params = defaultBiasParams(method, r.fitted.map.sceneScale);
    const ShadowMap& map = r.fitted.map;
    for (const ChosenFilter& filter :
         {ChosenFilter(kShadowFilterBilinear), ChosenFilter(kShadowFilterJitter4x4), jitterOfWidth(9.0f)}) {
      VisibilityPass pass(device(), r.view.width, r.view.height);
      pass.setUniforms(shadeUniforms(r.view, r.light, params));
      gpu::Commands commands(device(), "visibility");
      pass.record(commands, r.buffers, *r.gbuffer, *image, {.bias = method, .filter = filter});
      commands.submitAndWait();
      const auto visibility = gpu::downloadAs<float>(device(), pass.visibility());
      size_t different = 0, between = 0;
      for (size_t pixel = 0; pixel < visibility.size(); ++pixel) {
        if (r.receivers.states[pixel] != PixelState::Scored) continue;
        const SurfaceSample& sample = r.receivers.samples[pixel];
        Receiver receiver{lightFromWorld(r.fitted.frame, glm::vec3(sample.positionW)),
                          directionFromWorld(r.fitted.frame, glm::vec3(sample.normalW))};
        receiver = biasReceiver(method.id, map, params, receiver);
        const MapPoint point = mapProject(map, receiver.posL);
        const uint seed = pixelSeed({static_cast<int>(pixel) % r.view.width, static_cast<int>(pixel) / r.view.width});
        float lit = 0.0f, weights = 0.0f;
        for (int i = 0; i < filter.tapCount; ++i) {
          const FilterTap wanted = knownTap(filter, point.uv * static_cast<float>(map.width), seed, i);
          const MapTexel found = mapTexelAcross(map, point.slice, wanted.texel, receiver.posL);
          if (!found.held) continue;
          const auto at = static_cast<size_t>(found.texel.y * map.width + found.texel.x);
          Tap tap = emptyTap(found.slice, found.texel, mapTexelRay(map, found.slice, mapTexelCenter(map, found.texel)));
          tap.z1 = depth[at];
          if (two) tap.z2 = second[at];
          bool known = false;
          if (biasLit(method.id, map, params, receiver, tap, known)) lit += wanted.weight;
          weights += wanted.weight;
        }
        const float expected = weights > 0.0f ? lit / weights : 1.0f;
        different += std::abs(expected - visibility[pixel]) > 1e-5f ? 1 : 0;
        between += expected > 0.0f && expected < 1.0f ? 1 : 0;
      }
      // The receiver of the truth is computed in double and the shader's in float: a tap in a thousand may
      // fall otherwise.
      EXPECT_LE(different, r.receivers.scored / 100) << name << " " << filter.id;
      EXPECT_GT(between, 100u) << name << " " << filter.id;
    }
  }
}

TEST_F(FilterOnTheGpu, AnUnknownFilterIsMarkedForMagenta) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 64, 64, CullMode::Solids);
  VisibilityPass pass(device(), r.view.width, r.view.height);
  pass.setUniforms(shadeUniforms(r.view, r.light, {}));
  gpu::Commands commands(device(), "visibility");
  pass.record(commands, r.buffers, *r.gbuffer, *r.image, {.bias = findBias("none"), .filter = 999});
  commands.submitAndWait();
  const auto visibility = gpu::downloadAs<float>(device(), pass.visibility());
  EXPECT_GT(std::ranges::count(visibility, kUnknownVisibility), 100);
}

}  // namespace
}  // namespace gnomon
