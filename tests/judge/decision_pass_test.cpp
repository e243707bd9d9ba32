// Several methods in one dispatch say of each pixel what each says in its own, bit for bit: on every kind of map, of
// meshes with matrices and without, with holes, with the user's bias, and with the same bias at other values.
#include "shadow/decision_pass.h"

#include "lit_map.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"
#include "shadow/user_bias.h"
#include "tests/base/scenes_to_test.h"

#include <algorithm>

namespace gnomon {
namespace {

using test::LitMap;

constexpr int kPictureSide = 96;
constexpr int kMapSide = 64;  // coarse: every method is wrong somewhere

class DecisionPassTest : public gpu::GpuTest {};

// Each method's pixels, decided by one dispatch each few.
std::vector<std::vector<glsl::PixelDiagnosis>> decideTogether(LitMap& map, const std::vector<Method>& methods,
                                                              size_t& dispatches) {
  std::vector<const BiasMethod*> biases;
  std::vector<glsl::BiasParams> params;
  for (const Method& method : methods) {
    biases.push_back(method.bias);
    params.push_back(method.params);
  }
  std::vector<std::vector<glsl::PixelDiagnosis>> pixels;
  const Occluders& drawn = map.lit.occluders(methods.front().bias->channels);
  while (pixels.size() < methods.size()) {
    const std::span rest = std::span<const BiasMethod* const>(biases).subspan(pixels.size());
    const std::span together = rest.first(map.passes.decisions.mostOf(rest));
    gpu::Commands commands(map.seen.device(), "decisions");
    EXPECT_TRUE(drawn.recordDecisions(commands, map.seen.buffers(), map.seen.gbuffer(), map.passes.decisions, together,
                                      std::span(params).subspan(pixels.size(), together.size()),
                                      shadeUniforms(map.seen.view(), map.lit.light(), {})));
    commands.submitAndWait();
    const Decisions decisions = map.passes.decisions.download(together);
    for (size_t i = 0; i < together.size(); ++i) pixels.push_back(decisions.of(i));
    ++dispatches;
  }
  return pixels;
}

// How many pixels of a method are lit where the map covers them.
size_t expectAsAlone(LitMap& map, const Method& method, const std::vector<glsl::PixelDiagnosis>& together,
                     const std::string& what) {
  const std::vector<glsl::PixelDiagnosis> alone = map.lit.diagnose(method);
  const std::vector<float> visibility = map.lit.visibility(method);
  size_t different = 0, otherVisibility = 0, lit = 0;
  for (size_t i = 0; i < alone.size(); ++i) {
    different += std::memcmp(&alone[i], &together[i], sizeof alone[i]) != 0 ? 1 : 0;
    otherVisibility +=
        visibility[i] != visibilityOf(together[i], map.seen.primitiveIds()[i].instancePlusOne == 0) ? 1 : 0;
    lit += verdictOf(together[i]) == Verdict::Lit ? 1 : 0;
  }
  EXPECT_EQ(different, 0u) << what;
  EXPECT_EQ(otherVisibility, 0u) << what;
  return lit;
}

TEST_F(DecisionPassTest, EachMethodSaysWhatItSaysAlone) {
  const auto user =
      readUserBias("mine.glsl",
                   "//! knob: offset metres 0 10 0.01\n"
                   "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n"
                   "  return mapDistance(map, tap.slice, tap.ray, tap.z1) + params.knobs[kUserOffset] >\n"
                   "         mapDistance(map, tap.slice, tap.ray, mapDepth(map, tap.slice, receiver.posL));\n"
                   "}\n");
  const Parameterization* maps[] = {&cubeParameterization(), &paraboloidParameterization(), &spotParameterization(),
                                    &directionalParameterization()};
  for (const Parameterization* kind : maps) {
    for (const char* scene : test::scenesToTest({"atrium", "crowd:10000", "sheets"})) {
      LitMap map(device(), scene, *kind, kPictureSide, {.side = kMapSide});
      std::map<ChannelSet, std::vector<Method>> groups;
      for (const BiasMethod& bias : biasMethods())
        if (!bias.knowsSurfaces()) groups[bias.channels].push_back(atDefaults(bias, map.seen));
      groups[user->method.channels].push_back(atDefaults(user->method, map.seen));
      size_t dispatches = 0, methods = 0;
      std::set<size_t> lit;
      for (const auto& [channels, group] : groups) {
        const auto together = decideTogether(map, group, dispatches);
        for (size_t i = 0; i < group.size(); ++i)
          lit.insert(expectAsAlone(map, group[i], together[i],
                                   std::string(kind->name()) + " " + scene + " " + group[i].bias->name));
        methods += group.size();
      }
      EXPECT_LT(dispatches * 3, methods);
      EXPECT_GT(lit.size(), 8u) << kind->name() << " " << scene;  // they differ
    }
  }
}

TEST_F(DecisionPassTest, OneMethodAtSeveralValues) {
  for (const char* name : {"constant", "normal-offset", "adaptive"}) {
    LitMap map(device(), "atrium", cubeParameterization(), kPictureSide, {.side = kMapSide});
    std::vector<Method> methods;
    for (const float factor : {0.0f, 0.1f, 1.0f, 10.0f, 100.0f}) {
      methods.push_back(atDefaults(findBias(name), map.seen));
      methods.back().params.knobs[0] *= factor;
    }
    size_t dispatches = 0;
    const auto together = decideTogether(map, methods, dispatches);
    EXPECT_EQ(dispatches, 1u);
    std::set<size_t> lit;
    for (size_t i = 0; i < methods.size(); ++i) lit.insert(expectAsAlone(map, methods[i], together[i], name));
    EXPECT_GT(lit.size(), 3u) << name;
  }
}

// What is expected is decided together, whatever the order in which it is asked for; what knows surfaces is decided
// alone.
TEST_F(DecisionPassTest, ExpectedMethodsAreJudgedAsOthersAre) {
  LitMap map(device(), "atrium", cubeParameterization(), kPictureSide, {.side = kMapSide});
  LitMap alone(device(), "atrium", cubeParameterization(), kPictureSide, {.side = kMapSide});
  std::vector<Method> methods;
  for (const BiasMethod& bias : biasMethods()) methods.push_back(atDefaults(bias, map.seen));
  map.lit.expect(methods);
  std::rotate(methods.begin(), methods.begin() + 4, methods.end());
  for (const Method& method : methods) {
    const LabelledResult expected = map.lit.judge(method), own = alone.lit.judge(method);
    EXPECT_EQ(expected.visibility, own.visibility) << method.bias->name;
    EXPECT_EQ(expected.labels.labels, own.labels.labels) << method.bias->name;
    EXPECT_EQ(expected.grazing, own.grazing) << method.bias->name;
    EXPECT_EQ(expected.walks.steps, own.walks.steps) << method.bias->name;
  }
}

TEST_F(DecisionPassTest, OnlyMethodsThatReadTheSameShareADispatch) {
  EXPECT_TRUE(decidedTogether(findBias("none"), findBias("normal-offset")));
  EXPECT_TRUE(decidedTogether(findBias("midpoint"), findBias("dual")));
  EXPECT_FALSE(decidedTogether(findBias("none"), findBias("dual")));
  EXPECT_FALSE(decidedTogether(findBias("none"), findBias("two-plane-depth")));
  EXPECT_FALSE(decidedTogether(findBias("two-plane"), findBias("priority-depth")));
  const auto first = readUserBias("a.glsl", "bool userLit() { return true; }"),
             second = readUserBias("b.glsl", "bool userLit() { return false; }");
  EXPECT_TRUE(decidedTogether(findBias("none"), first->method));
  EXPECT_FALSE(decidedTogether(first->method, second->method));
}

// A picture whose words would not fit into the device's largest buffer takes fewer methods at once.
TEST_F(DecisionPassTest, LargePicturesTakeFewerAtOnce) {
  std::vector<const BiasMethod*> biases(20, &findBias("none"));
  EXPECT_EQ(DecisionPass(device(), 64, 64).mostOf(biases), static_cast<size_t>(glsl::kMostTogether));
  const auto side = static_cast<int>(std::sqrt(static_cast<double>(device().info().maxStorageBufferBytes) / 8.0));
  EXPECT_EQ(DecisionPass(device(), side, side).mostOf(biases), size_t{4});
}

}  // namespace
}  // namespace gnomon
