#include "view/picture_worker.h"

#include "lab/compare/render_picture.h"
#include "lab/core/maps.h"
#include "lab/fog/fog.h"
#include "tests/gpu/gpu_fixture.h"
#include "view/pixel_facts.h"
#include "view/view_controls.h"
#include "vsv/volume_parameterization.h"

#include <chrono>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

constexpr int kWidth = 96, kHeight = 72;  // pixels

ViewState stateOf(const std::string& scene) {
  CompareOptions options;
  options.maps = parseMaps("cube");
  options.biases = {&findBias("constant")};
  options.mapSide = 64;
  SetupOptions setup;
  setup.scene = scene;
  return initialState(setup, options);
}

class PictureWorkerTest : public ::testing::Test {
 protected:
  PictureWorkerTest() : worker_({.validation = true}, [] {}) {}
  ~PictureWorkerTest() override { EXPECT_EQ(worker_.validationMessages(), 0u); }

  std::shared_ptr<const ViewPicture> refined(const ViewState& state, uint64_t number) {
    worker_.ask({.state = state, .number = number, .width = kWidth, .height = kHeight});
    for (int i = 0; i < 60000; ++i) {
      const auto newest = worker_.newest();
      if (newest && newest->number == number && newest->refined && worker_.isIdle()) return newest;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "no picture in a minute";
    return std::make_shared<ViewPicture>();
  }

  PictureWorker worker_;
};

Image8 rendered(const ViewState& state, size_t side) {
  SetupOptions setup = state.setup;
  setup.size = fmt::format("{}x{}", kWidth, kHeight);
  const Session session({.validation = true}, setup);
  return renderPicture(session, state.sides[side].options, state.sides[side].show).png;
}

// To the byte, whatever is shown, and whatever was drawn before.
TEST_F(PictureWorkerTest, AtRestIsWhatRenderWrites) {
  ViewState state = stateOf("atrium");
  state.split = true;
  state.sides[1].options.maps = parseMaps("paraboloid");
  state.sides[1].options.biases = {&findBias("adaptive")};
  uint64_t number = 0;
  for (const char* show : {"beauty", "labels", "difference"}) {
    state.sides[0].show = state.sides[1].show = show;
    for (size_t side = 0; side < 2; ++side) {
      const auto picture = refined(state, ++number);
      EXPECT_EQ(picture->problem, "");
      EXPECT_EQ(picture->sides[side].image.values, rendered(state, side).values) << show;
    }
  }
  // After the light and the camera have moved, at other sizes between.
  const auto traced = worker_.newest()->traced;
  moveLight(state, *traced, {0.5, 3.0, 0.25});
  worker_.ask({.state = state, .number = ++number, .moving = true, .width = kWidth, .height = kHeight});
  placeCamera(state, *traced, {3, 2, 3}, {0, 1, 0}, 60.0);
  worker_.ask({.state = state, .number = ++number, .moving = true, .width = kWidth, .height = kHeight});
  state.sides[0].show = state.sides[1].show = "beauty";
  const auto moved = refined(state, ++number);
  for (size_t side = 0; side < 2; ++side) EXPECT_EQ(moved->sides[side].image.values, rendered(state, side).values);
}

// Sides that ask for one map share it until one of them asks for another.
TEST_F(PictureWorkerTest, SidesShareAMapAndPart) {
  ViewState state = stateOf("lshape");
  state.split = true;
  refined(state, 1);
  uint64_t number = 1;
  for (const size_t side : {size_t{1}, size_t{0}}) {
    for (const char* map : {"spot", "cube", "paraboloid", "cube"}) {
      state.sides[side].options.maps = parseMaps(map);
      const auto picture = refined(state, ++number);
      EXPECT_EQ(picture->problem, "");
      for (size_t shown = 0; shown < 2; ++shown) {
        EXPECT_TRUE(picture->sides[shown].counts) << map;
        EXPECT_EQ(picture->sides[shown].image.values, rendered(state, shown).values) << map << " " << side;
      }
    }
  }
}

TEST_F(PictureWorkerTest, FogAtRestIsWhatFogWrites) {
  ViewState state = stateOf("grate");
  state.fog.on = true;
  state.fog.sigmaS = 0.1;
  state.sides[0].options.mapOptions = {kVolumeSize(VolumeSize{128, 64, 128})};
  const auto picture = refined(state, 1);
  EXPECT_EQ(picture->problem, "");
  SetupOptions setup = state.setup;
  setup.size = fmt::format("{}x{}", kWidth, kHeight);
  const Session session({.validation = true}, setup);
  FogOptions options{.integrators = {&integrators().front()},
                     .marchMap = parseMaps("cube").front(),
                     .map = state.sides[0].options.mapOptions,
                     .medium = fogMediumOf(state.fog, session.scene().originW),
                     .repeats = 1};
  const FogResult result = runFog(session, options);
  const Image8 wanted = exposed(composed(result.view, result.inScattered.front()), result.exposure);
  EXPECT_EQ(picture->sides[0].image.values, wanted.values);
}

// The counts are those of the labels, and each scored pixel has its reason.
TEST_F(PictureWorkerTest, PixelsHaveReasons) {
  ViewState state = stateOf("atrium");
  state.sides[0].options.biases = {&findBias("none")};
  state.loupe = true;
  state.unfolded = true;
  const auto picture = refined(state, 1);
  ASSERT_TRUE(picture->counted);
  const LabelledResult& judged = *picture->sides[0].judged;
  ASSERT_GT(judged.labels.count(Label::Acne), 100u);
  EXPECT_EQ(picture->sides[0].unfolded.width, 4 * 64);
  const auto acne = std::ranges::find(judged.labels.labels, Label::Acne) - judged.labels.labels.begin();
  const glm::ivec2 pixel(static_cast<int>(acne) % kWidth, static_cast<int>(acne) / kWidth);
  std::string all;
  for (const std::string& fact : pixelFacts(*picture, 0, pixel)) all += fact + "\n";
  for (const char* part : {"exact shadow: lit", "A cube none: in shadow, acne", "it holds",
                           "its ray meets the receiver's plane", "the bias was too small"})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
  // From the texel to the unfolded picture and back.
  const auto place = texelOf(*picture, 0, pixel);
  ASSERT_TRUE(place);
  const auto back = texelAtUnfolded(*picture->sides[0].fitted, placeInUnfolded(*picture->sides[0].fitted, *place));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->slice, place->slice);
  EXPECT_EQ(back->texel, place->texel);
}

// Whatever of a map a bias reads, the loupe and the unfolded map have something to show.
TEST_F(PictureWorkerTest, WhatAnyBiasReadsIsExplained) {
  ViewState state = stateOf("lshape");
  state.loupe = true;
  state.unfolded = true;
  std::set<ChannelSet> seen;
  uint64_t number = 0;
  for (const BiasMethod& bias : biasMethods()) {
    if (!seen.insert(bias.channels).second) continue;
    state.sides[0].options.biases = {&bias};
    const auto picture = refined(state, ++number);
    EXPECT_EQ(picture->problem, "") << bias.name;
    ASSERT_TRUE(picture->sides[0].depths) << bias.name;
    EXPECT_FALSE(picture->sides[0].unfolded.values.empty()) << bias.name;
    EXPECT_GT(pixelFacts(*picture, 0, {kWidth / 2, kHeight / 2}).size(), 2u) << bias.name;
  }
  EXPECT_GT(seen.size(), 3u);
}

// What cannot be drawn is told, and the last picture stays.
TEST_F(PictureWorkerTest, ProblemsLeaveTheLastPicture) {
  ViewState state = stateOf("lshape");
  const auto good = refined(state, 1);
  ViewState broken = state;
  broken.setup.scene = "no/such/file.glb";
  const auto problem = refined(broken, 2);
  EXPECT_TRUE(problem->sceneFailed);
  EXPECT_NE(problem->problem.find("no/such/file.glb"), std::string::npos) << problem->problem;
  EXPECT_EQ(problem->sides[0].image.values, good->sides[0].image.values);
  EXPECT_EQ(refined(state, 3)->problem, "");
}

TEST_F(PictureWorkerTest, ALostDeviceIsMadeAnew) {
  const ViewState state = stateOf("lshape");
  const auto before = refined(state, 1);
  worker_.loseDevice();
  const auto after = refined(state, 2);
  EXPECT_EQ(after->problem, "");
  EXPECT_EQ(after->sides[0].image.values, before->sides[0].image.values);
}

// While something moves there are as many pixels as the budget allows, at rest all.
TEST_F(PictureWorkerTest, PixelsFollowTheBudget) {
  ViewState state = stateOf("atrium");
  state.budgetMs = 1.0;
  refined(state, 1);
  const auto traced = worker_.newest()->traced;
  int width = kWidth;
  for (uint64_t number = 2; number < 12; ++number) {
    moveLight(state, *traced, {0.1 * static_cast<double>(number), 3.0, 0.25});
    worker_.ask({.state = state, .number = number, .moving = true, .width = kWidth, .height = kHeight});
    while (worker_.newest()->number < number) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    width = worker_.newest()->width;
  }
  EXPECT_LT(width, kWidth / 2);
  EXPECT_EQ(refined(state, 12)->width, kWidth);
}

}  // namespace
}  // namespace gnomon
