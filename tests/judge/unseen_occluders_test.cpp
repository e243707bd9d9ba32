// Which of the wrong pixels a map that names triangles could have known better.
#include "judge/light_on_map.h"
#include "lit_map.h"
#include "omni/cube_map.h"
#include "tests/truth/scenes_by_hand.h"

namespace gnomon {
namespace {

class UnseenOccludersTest : public gpu::GpuTest {};

// A lamp at 4 m, a floor, and half-way a pole along the z axis. A cube's face has an even number of texels a side here,
// so that the axis lies between two columns of their centres, and a pole narrower than their spacing in no texel.
Scene poleUnderLamp(double width) {
  Scene scene = test::emptyScene();
  test::addFloor(scene, 0.0, 3.0);
  test::addBox(scene, {-0.5 * width, 2.0, -1.0}, {0.5 * width, 2.0 + 0.5 * width, 1.0});
  scene.lights.push_back({.name = "lamp", .type = LightType::Point, .positionW = {0.0f, 4.0f, 0.0f}});
  scene.cameras.push_back(lookAt("beside", {2.5f, 3.0f, 2.0f}, {0.0f, 0.0f, 0.0f}, 1.0f));
  return scene;
}

struct Pole {
  SceneView seen;
  ShadowPasses passes;
  LightOnMap lit;
  Pole(const gpu::Device& device, double width)
      : seen(test::lent(device), poleUnderLamp(width), 256, 256),
        passes(seen),
        lit(seen, passes, cubeParameterization(), {.side = 64}) {}
};

constexpr double kTexelAtPole = 2.0 * 2.0 / 64.0;  // metres

TEST_F(UnseenOccludersTest, APoleNarrowerThanATexelIsSeenByNone) {
  Pole pole(device(), 0.5 * kTexelAtPole);
  const Receivers& receivers = pole.lit.receivers();
  size_t inShadow = 0;
  for (size_t i = 0; i < receivers.states.size(); ++i)
    inShadow += receivers.states[i] == PixelState::Scored && pole.lit.truth().lit[i] == 0 ? 1 : 0;
  ASSERT_GT(inShadow, 200u);
  for (const char* bias : {"witness", "two-plane"}) {
    const LabelledResult judged = pole.lit.judge(atDefaults(findBias(bias), pole.seen));
    ASSERT_TRUE(judged.labels.unseen) << bias;
    EXPECT_EQ(judged.labels.count(Label::EdgeLight), inShadow) << bias;
    EXPECT_EQ(judged.labels.unseen->occluders, inShadow) << bias;
    EXPECT_EQ(judged.labels.unseen->surfaces, inShadow) << bias;
  }
}

TEST_F(UnseenOccludersTest, OfAWiderPoleOnlyWhatNoWalkReachesIsLeft) {
  Pole pole(device(), 2.4 * kTexelAtPole);
  const LabelledResult witness = pole.lit.judge(atDefaults(findBias("witness"), pole.seen));
  const LabelledResult planes = pole.lit.judge(atDefaults(findBias("two-plane"), pole.seen));
  const auto light = [](const LabelledResult& judged) {
    return judged.labels.count(Label::Leak) + judged.labels.count(Label::EdgeLight);
  };
  // two-plane asks one texel: where that misses the pole, a neighbour of it names the pole.
  EXPECT_GT(light(planes), 100u);
  EXPECT_LT(planes.labels.unseen->occluders, light(planes) / 4);
  EXPECT_EQ(witness.labels.unseen->occluders, light(witness));
  EXPECT_LT(witness.labels.unseen->occluders, light(planes) / 4);
}

// What a texel names and a walk begins at shadows its pixel: so no wrong pixel of `witness` has its occluder named.
TEST_F(UnseenOccludersTest, AllThatWitnessHasWrongIsUnseen) {
  for (const char* scene : {"factory", "sheets"}) {
    // On the smallest of these maps every twentieth receiver's texels lie across an edge of a face.
    for (const auto& [reach, side] : {std::pair(2, 96), std::pair(4, 96), std::pair(2, 24)}) {
      test::LitMap map(device(), scene, cubeParameterization(), 192, {.side = side});
      Method method = atDefaults(findBias("witness"), map.seen);
      method.params.witnessReach = reach;
      const LabelledResult judged = map.lit.judge(method);
      const size_t wrong = judged.labels.count(Label::Leak) + judged.labels.count(Label::EdgeLight);
      EXPECT_GT(wrong, 0u) << scene;
      EXPECT_EQ(judged.labels.unseen->occluders, wrong) << scene << " " << reach << " " << side;
    }
  }
}

TEST_F(UnseenOccludersTest, ABiasOfDepthsHasNone) {
  Pole pole(device(), kTexelAtPole);
  EXPECT_FALSE(pole.lit.judge(atDefaults(findBias("adaptive"), pole.seen)).labels.unseen);
}

}  // namespace
}  // namespace gnomon
