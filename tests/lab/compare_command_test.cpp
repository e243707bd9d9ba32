// Command lines that make a comparison, or a row of it, again: what is at its default is left out, what is not is
// there.
#include "lab/compare/compare_command.h"

#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"
#include "vsv/volume_parameterization.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

CompareOptions optionsOf(const Parameterization& map, const char* biases) {
  CompareOptions options;
  options.maps = {&map};
  options.biases = parseBiases(biases);
  return options;
}

TEST(CompareCommand, LeavesOutWhatIsAtItsDefault) {
  EXPECT_EQ(compareCommand({.scene = "atrium"}, optionsOf(spotParameterization(), "dual")),
            "gnomon compare atrium --maps spot --biases dual");
}

TEST(CompareCommand, SaysAllThatIsNot) {
  SetupOptions setup{.scene = "my scene.glb",
                     .light = "lamp 1",
                     .camera = "eye:0,1,2,target:0,0,0,fov:50",
                     .direction = "0,-1,0.5",
                     .coneDegrees = 67.5,
                     .size = "640x480"};
  CompareOptions options = optionsOf(directionalParameterization(), "slope,adaptive-ehm");
  options.maps.push_back(&cubeParameterization());
  options.mapSide = 512;
  options.mapOptions = {kCascades(3),
                        kSnap(false),
                        kWindowFit(WindowFit::Tight),
                        kCubeDepth(CubeDepth::Radial),
                        kCubePasses(SlicePasses::Each),
                        kParaboloidRaster(ParaboloidRaster::Tessellated),
                        kParaboloidAxisW(glm::dvec3(glm::vec3(0.1f, -2.0f, 0.0f))),
                        kVolumeSize({.alpha = 64, .theta = 32, .phi = 256}),
                        kVolumeSource(VolumeSource::Resample),
                        kVolumeFit(VolumeFit::Full)};
  options.cull = CullMode::None;
  options.choices.epsilonAt = glsl::kEpsilonAtStored;
  options.filters = parseFilters("none,bilinear");
  options.tune = true;
  options.knobs = {{&findBias("slope").knobs[0], 2.5f},
                   {&findBias("adaptive").knobs[0], 0.1f},
                   {&findBias("dual").knobs[0], 9.0f}};  // dual is not among the biases
  EXPECT_EQ(
      compareCommand(setup, options),
      "gnomon compare 'my scene.glb' --light 'lamp 1' --camera eye:0,1,2,target:0,0,0,fov:50 "
      "--direction 0,-1,0.5 --cone 67.5 --size 640x480 --maps directional,cube --map-size 512 --cascades 3 "
      "--cube-depth radial --cube-passes six --fit tight --paraboloid-axis 0.1,-2,0 --paraboloid-raster "
      "tessellated --snap off --vsv-fit full --vsv-size 64x32x256 --vsv-source resample --cull none --biases "
      "slope,adaptive-ehm --slope-factor 2.5 --adaptive-k 0.1 --epsilon-at stored --tune --filters none,bilinear");
  options.mapTexels = 65536;
  EXPECT_NE(compareCommand(setup, options).find("--map-texels 65536"), std::string::npos);
  EXPECT_EQ(compareCommand(setup, options).find("--map-size"), std::string::npos);
}

TEST(RowCommand, IsOfOneMapLightBiasAndFilter) {
  CompareOptions options = optionsOf(spotParameterization(), "all");
  options.maps.push_back(&cubeParameterization());
  options.filters = parseFilters("all");
  options.knobs = {{&findBias("dual").knobs[0], 0.5f}, {&findBias("constant").knobs[0], 0.25f}};
  Row row;
  row.map = "cube";
  row.bias = "dual";
  row.filter = "bilinear";
  row.light = "lamp";
  EXPECT_EQ(rowCommand({.scene = "atrium"}, options, row),
            "gnomon compare atrium --maps cube --biases dual --dual-offset 0.5 --filters bilinear");
  EXPECT_EQ(rowCommand({.scene = "atrium", .light = "all"}, options, row),
            "gnomon compare atrium --light lamp --maps cube --biases dual --dual-offset 0.5 --filters bilinear");
}

TEST(RowCommand, ATunedRowHasItsKnobAndATunedSumIsTunedAgain) {
  CompareOptions options = optionsOf(spotParameterization(), "all");
  options.tune = true;
  Row row;
  row.map = "spot";
  row.bias = "adaptive-clamped";
  row.tuning = Tuning{.knob = "k", .value = 0.0125f, .unit = ""};
  row.params = {{"k", 0.0125}};
  EXPECT_EQ(rowCommand({.scene = "atrium"}, options, row),
            "gnomon compare atrium --maps spot --biases adaptive-clamped --adaptive-k 0.0125");
  row.isSum = true;
  row.light = "all";
  row.params.clear();
  EXPECT_EQ(rowCommand({.scene = "atrium", .light = "all"}, options, row),
            "gnomon compare atrium --light all --maps spot --biases adaptive-clamped --tune");
  row.tuning.reset();
  EXPECT_EQ(rowCommand({.scene = "atrium", .light = "all"}, options, row),
            "gnomon compare atrium --light all --maps spot --biases adaptive-clamped");
}

TEST(RowCommand, AUsersBiasIsNamedWithItsFile) {
  const std::shared_ptr<const UserBias> mine =
      readUserBias("my dir/mine.glsl",
                   "//! knob: offset metres 0 10 0.001\n"
                   "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return true; }\n");
  CompareOptions options = optionsOf(cubeParameterization(), "none");
  options.userBiases = {mine};
  options.biases.push_back(&mine->method);
  options.knobs = {{&mine->method.knobs.front(), 0.75f}};
  Row row;
  row.map = "cube";
  row.bias = "mine";
  EXPECT_EQ(
      rowCommand({.scene = "atrium"}, options, row),
      "gnomon compare atrium --maps cube --bias-file 'my dir/mine.glsl' --biases mine --bias-file-knob offset=0.75");
  row.bias = "none";
  EXPECT_EQ(rowCommand({.scene = "atrium"}, options, row), "gnomon compare atrium --maps cube --biases none");
}

}  // namespace
}  // namespace gnomon
