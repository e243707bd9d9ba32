// Words of the command line to a light and a camera.
#include "lab/core/setup.h"
#include "base/error.h"
#include "lab/core/maps.h"
#include "planar/planar_map.h"
#include "scene/generate.h"

#include <functional>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

class SetupTest : public ::testing::Test {
 protected:
  Scene scene_ = findGeneratedScene("contact")->make();
  Tracer tracer_{scene_};
  SetupOptions options_;
};

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ParseSize, TakesOneOrTwoNumbers) {
  EXPECT_EQ(parseSize("512").height, 512);
  EXPECT_EQ(parseSize("640x480").width, 640);
  EXPECT_EQ(parseSize("640x480").height, 480);
  for (const char* text : {" ", "x", "0", "-4", "5x", "x5", "5x5x5", "5y5", "99999", "1e3"})
    EXPECT_THROW(parseSize(text), UsageError) << text;
}

TEST(ParseSize, WithoutOneKeepsTheCamerasAspect) {
  EXPECT_EQ(parseSize("").width, kDefaultSide);
  EXPECT_EQ(parseSize("").height, kDefaultSide);
  EXPECT_EQ(parseSize("", 16.0 / 9.0).width, 1024);
  EXPECT_EQ(parseSize("", 16.0 / 9.0).height, 576);
  EXPECT_EQ(parseSize("", 0.5).width, 512);
  EXPECT_EQ(parseSize("", 0.5).height, 1024);
  EXPECT_EQ(parseSize("", 1e-9).width, 1);
  EXPECT_EQ(parseSize("64", 2.0).height, 64);  // what is asked for is what there is
}

TEST(UsualMap, SuitsTheLightAndTheOptions) {
  EXPECT_STREQ(usualMapFor(LightType::Point, {}).name(), "cube");
  EXPECT_STREQ(usualMapFor(LightType::Spot, {}).name(), "spot");
  EXPECT_STREQ(usualMapFor(LightType::Directional, {}).name(), "directional");
  const auto with = [](const char* flag, const char* value) {
    for (const MapOption* option : allMapOptions())
      if (option->flag() == flag) return MapOptions{{option, option->parsed(value)}};
    ADD_FAILURE() << flag;
    return MapOptions{};
  };
  EXPECT_STREQ(usualMapFor(LightType::Point, with("--warp", "psm")).name(), "spot");
  EXPECT_STREQ(usualMapFor(LightType::Point, with("--cube-depth", "radial")).name(), "cube");
  EXPECT_STREQ(usualMapFor(LightType::Point, with("--paraboloid-raster", "vertex")).name(), "paraboloid");
}

TEST_F(SetupTest, ACameraFromTheCommandLineLooksWhereItIsTold) {
  options_.camera = "eye:1,2,3,target:1,2,-7,fov:50";
  const Camera camera = chooseCamera(options_, tracer_);
  EXPECT_EQ(glm::vec3(camera.worldFromEye[3]), glm::vec3(1, 2, 3));
  EXPECT_NEAR(camera.worldFromEye[2].z, 1.0f, 1e-6f);  // looks along -z
  EXPECT_NEAR(glm::degrees(camera.yFovRad), 50.0f, 1e-4f);
}

TEST_F(SetupTest, MalformedCamerasAndLightsAreRefused) {
  for (const char* text : {"eye:1,2,target:0,0,0", "eye:1,2,3", "eye:1,2,3,target:1,2,3", "eye:a,b,c,target:0,0,0",
                           "eye:1,2,3,target:0,0,0,fov:200", "eye:1,2,3,target:0,0,0,roll:2"}) {
    options_.camera = text;
    EXPECT_THROW(chooseCamera(options_, tracer_), UsageError) << text;
  }
  options_.light = "moon";
  EXPECT_NE(messageOf([&] { chooseLight(options_, tracer_, spotParameterization()); }).find(scene_.lights.front().name),
            std::string::npos);
  options_.light = "1,2,nan";
  EXPECT_THROW(chooseLight(options_, tracer_, spotParameterization()), UsageError);
}

TEST_F(SetupTest, PlacesTooFarForFloatsAreRefusedWithTheFarthest) {
  options_.light = "0,1e19,0";
  EXPECT_NE(messageOf([&] { chooseLight(options_, tracer_, spotParameterization()); }).find("at most 5e+17 metres"),
            std::string::npos);
  options_.light = "0,5e17,0";
  EXPECT_EQ(messageOf([&] { chooseLight(options_, tracer_, spotParameterization()); }), "");
  for (const char* text : {"eye:1e19,0,0,target:0,0,0", "eye:0,0,0,target:0,0,-1e18"}) {
    options_.camera = text;
    EXPECT_THROW(chooseCamera(options_, tracer_), UsageError) << text;
  }
  // A direction has no length that matters.
  options_.light.clear();
  for (const char* text : {"0,-1e30,0", "0,-1e-30,0"}) {
    options_.direction = text;
    EXPECT_EQ(chooseLight(options_, tracer_, spotParameterization()).directionW, glm::vec3(0, -1, 0)) << text;
  }
}

TEST_F(SetupTest, EveryMapFindsALightItCanTake) {
  for (const GeneratedScene& generated : generatedScenes()) {
    const Scene scene = generated.make();
    const Tracer tracer(scene);
    for (const Parameterization* map : parameterizations()) {
      const Light light = chooseLight({}, tracer, *map);
      EXPECT_NE(map->supportsLight(light.type), LightSupport::No) << generated.name << " " << map->name();
    }
  }
}

TEST_F(SetupTest, ADirectionalLightIsNoSpot) {
  scene_.lights = {Light{.name = "sun", .type = LightType::Directional}};
  options_.light = "sun";
  EXPECT_NE(messageOf([&] { chooseLight(options_, tracer_, spotParameterization()); }).find("--maps directional"),
            std::string::npos);
}

TEST_F(SetupTest, WithoutLightsOneStandsAboveTheScene) {
  scene_.lights.clear();
  const Light light = chooseLight({}, tracer_, spotParameterization());
  EXPECT_GT(light.positionW.y, computeBounds(scene_).upper.y);
}

}  // namespace
}  // namespace gnomon
