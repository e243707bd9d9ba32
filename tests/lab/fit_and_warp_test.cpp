// Biases know nothing of fits, warps and cascades: adaptive keeps `tilted-planes` clean on all of them, and a result
// says which it was.
#include "base/file.h"
#include "judge/texel_density.h"
#include "lab/compare/compare.h"
#include "lab/compare/results.h"
#include "lab/core/maps.h"
#include "lab/picture/pictures.h"
#include "planar/planar_map.h"
#include "tests/gpu_fixture.h"

#include <set>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using Json = nlohmann::json;

TEST(FitAndWarp, AdaptiveHasNeitherAcneNorLeakOnSlopeUnderAnyOfThem) {
  const SetupOptions setup{.scene = "tilted-planes", .size = "256"};
  const Session session({.validation = true}, setup);
  const bool isLavapipe = session.device().info().driver.starts_with("llvmpipe");
  ShadowPasses passes(session);
  std::vector<MapOptions> all;
  for (const WindowFit fit : {WindowFit::None, WindowFit::Tight, WindowFit::Focused}) {
    for (const Warp warp : {Warp::None, Warp::Psm, Warp::Lispsm, Warp::Tsm})
      all.push_back({kWindowFit(fit), kWarp(warp)});
    all.push_back({kWindowFit(fit), kCascades(4)});
  }
  all.push_back({kSnap(false)});
  for (const char* name : {"spot", "directional"}) {
    const LightOnMap light = openLight(session, passes, *parseMaps(name).front(), {});
    for (const MapOptions& options : all) {
      const std::string what = std::string(name) + " " + options.text(kWindowFit) + " " + options.text(kWarp) + " " +
                               options.text(kCascades);
      LightOnMap lit(light, {.side = 256, .options = options});
      const LabelledResult none = lit.judge(atDefaults(findBias("none"), session));
      EXPECT_GT(none.labels.count(Label::Acne), lit.receivers().scored / 50) << what;
      const LabelledResult adaptive = lit.judge(atDefaults(findBias("adaptive"), session));
      // A GPU interpolates depth between corners on a grid of 1/256 texel: the paper's epsilon is less than that.
      EXPECT_LE(adaptive.labels.count(Label::Acne), isLavapipe ? 0u : none.labels.count(Label::Acne) / 10) << what;
      EXPECT_EQ(adaptive.labels.count(Label::Leak), 0u) << what;
      EXPECT_EQ(adaptive.labels.count(Label::Uncovered), 0u) << what;
    }
  }
  EXPECT_TRUE(session.device().validationMessages().empty());
}

TEST(FitAndWarp, AResultSaysHowItsMapWasFitted) {
  const SetupOptions setup{.scene = "contact", .size = "64"};
  const Session session({.validation = true}, setup);
  CompareOptions options;
  options.maps = parseMaps("directional");
  options.biases = parseBiases("adaptive");
  options.mapSide = 64;
  options.repeats = 1;
  const auto rowOf = [&](const MapOptions& mapOptions) {
    options.mapOptions = mapOptions;
    return Json::parse(resultsJson(session, compare(session, options), "gnomon compare")).at("rows")[0];
  };
  const Json warped = rowOf({kWindowFit(WindowFit::Tight), kWarp(Warp::Lispsm)});
  EXPECT_EQ(warped.at("params").at("fit"), "tight");
  EXPECT_EQ(warped.at("params").at("warp"), "lispsm");
  EXPECT_EQ(warped.at("params").at("snap"), "off");
  EXPECT_EQ(warped.at("params").at("cascades"), 1);
  const Json split = rowOf({kCascades(3)});
  EXPECT_EQ(split.at("params").at("cascades"), 3);
  EXPECT_EQ(split.at("params").at("snap"), "on");
  EXPECT_EQ(split.at("layers"), 3);
  EXPECT_EQ(split.at("map_texels"), 3 * 64 * 64);
}

TEST(DensityPicture, RisesInLightnessWithTheDensityAndMarksWhatIsUncovered) {
  Receivers receivers;
  receivers.width = 600;
  receivers.height = 1;
  receivers.states.assign(600, PixelState::Scored);
  receivers.samples = SurfaceSamples(PerPixel<SurfaceSample>(600));
  std::vector<float> densities;
  for (int i = 0; i < 600; ++i) densities.push_back(std::pow(10.0f, 1.0f + 3.0f * static_cast<float>(i) / 599.0f));
  densities[300] = -1.0f;
  const Image8 picture = densityPicture(receivers, densities, "title");
  int before = -1;
  for (int x = 0; x < 600; x += 50) {
    if (x == 300) continue;
    const uint8_t* p = picture.at(x, 0);
    const int lightness = 2 * p[0] + 7 * p[1] + p[2];
    EXPECT_GT(lightness, before) << x;
    before = lightness;
  }
  EXPECT_EQ(picture.at(300, 0)[0], 204);
  EXPECT_EQ(picture.at(300, 0)[1], 121);
}

}  // namespace
}  // namespace gnomon
