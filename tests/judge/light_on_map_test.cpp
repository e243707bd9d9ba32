// One light on one map: what it is taken as, what is drawn, and labels that follow from verdicts and truth.
#include "judge/light_on_map.h"

#include "base/error.h"
#include "lit_map.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <functional>

namespace gnomon {
namespace {

using test::LitMap;

// A map each of a point, a spot and a directional light, and a volume.
const std::vector<const Parameterization*>& everyMap() {
  static const std::vector<const Parameterization*> maps = {&cubeParameterization(), &spotParameterization(),
                                                            &directionalParameterization(), &volumeParameterization()};
  return maps;
}

MapSetup smallSetup() {
  return {.side = 64, .options = {kVolumeSize({.alpha = 64, .theta = 64, .phi = 128})}};
}

class LightOnMapTest : public gpu::GpuTest {};

TEST_F(LightOnMapTest, ALightIsTakenAsTheMapTakesIt) {
  const LightType types[] = {LightType::Point, LightType::Spot, LightType::Directional, LightType::Point};
  for (size_t i = 0; i < everyMap().size(); ++i) {
    const LitMap map(device(), "atrium", *everyMap()[i], 64, smallSetup());
    EXPECT_EQ(map.lit.light().type, types[i]) << everyMap()[i]->name();
    EXPECT_EQ(everyMap()[i]->supportsLight(map.lit.source().type), LightSupport::Yes) << everyMap()[i]->name();
  }
}

// A spot's own direction and cone, so that some pixels lie outside of it.
TEST_F(LightOnMapTest, ASpotKeepsItsDirectionAndItsCone) {
  const SceneView seen(test::lent(device()), openScene("contact"), 64, 64);
  ShadowPasses passes(seen);
  const Bounds bounds = computeBounds(seen.scene());
  const Light spot{.type = LightType::Spot,
                   .positionW = bounds.center() + glm::vec3(0.0f, bounds.diagonal(), 0.0f),
                   .directionW = {0, -1, 0},
                   .outerConeRad = 0.05f};
  const LightOnMap lit(seen, passes, spotParameterization(), spot, smallSetup());
  EXPECT_EQ(lit.light().type, LightType::Spot);
  EXPECT_EQ(lit.light().directionW, glm::dvec3(0, -1, 0));
  EXPECT_GT(lit.receivers().outsideCone, 100u);
  EXPECT_GT(lit.receivers().scored, 20u);
}

// What could not be drawn (lavapipe's multiview draws other slices) is not taken for a map the next time.
TEST_F(LightOnMapTest, AMapThatCannotBeDrawnIsNoMapTheSecondTimeEither) {
  LitMap map(device(), "contact", cubeParameterization(), 64,
             {.side = 32, .options = {kCubePasses(SlicePasses::Multiview)}});
  const auto draws = [&] {
    try {
      map.lit.occluders(glsl::kChannelDepth);
      return true;
    } catch (const WorldError&) {
      return false;
    }
  };
  if (draws()) GTEST_SKIP() << "this device draws by multiview";
  EXPECT_FALSE(draws());
}

// A light that has moved is drawn into the room of the one before, and a camera into its view's: the bits are those of
// what is made for the purpose.
TEST_F(LightOnMapTest, RoomIsUsedAgain) {
  SceneView seen(test::lent(device()), openScene("atrium"), 64, 64);
  ShadowPasses passes(seen);
  for (const Parameterization* map : everyMap()) {
    const Light source = *firstLightFor(seen.scene(), *map);
    Light moved = source;
    moved.positionW += glm::vec3(0.3f, -0.2f, 0.1f);
    const Method method = atDefaults(findBias(map->supportsBias(findBias("witness")) ? "witness" : "none"), seen);
    LightOnMap before(seen, passes, *map, source, smallSetup());
    before.occluders(method.bias->channels);
    const Occluders* room = &before.occluders(method.bias->channels);
    LightOnMap after(seen, passes, *map, moved, smallSetup()), anew(seen, passes, *map, moved, smallSetup());
    after.takeRoomOf(before);
    EXPECT_EQ(after.picture(method).values, anew.picture(method).values) << map->name();
    EXPECT_EQ(after.judge(method).verdicts, anew.judge(method).verdicts) << map->name();
    EXPECT_EQ(&after.occluders(method.bias->channels), room) << map->name();
    // Of another form there is other room.
    MapSetup larger = smallSetup();
    larger.side = 128;
    larger.options = {kVolumeSize({.alpha = 128, .theta = 64, .phi = 128})};
    LightOnMap other(seen, passes, *map, moved, larger), otherAnew(seen, passes, *map, moved, larger);
    other.takeRoomOf(after);
    EXPECT_EQ(other.picture(method).values, otherAnew.picture(method).values) << map->name();
  }
}

TEST_F(LightOnMapTest, AViewLooksFromElsewhere) {
  SceneView seen(test::lent(device()), openScene("atrium"), 64, 64);
  Camera camera = seen.camera();
  camera.worldFromEye[3] += glm::vec4(0.5f, 0.25f, -0.5f, 0.0f);
  const SceneView anew(seen, camera);
  seen.surfaces();
  seen.lookFrom(camera);
  ShadowPasses passes(seen);
  const auto ofView = [&](const SceneView& view) {
    LightOnMap lit(view, passes, cubeParameterization(), smallSetup());
    return lit.judge(atDefaults(findBias("constant"), view));
  };
  const LabelledResult one = ofView(seen), two = ofView(anew);
  EXPECT_EQ(one.verdicts, two.verdicts);
  EXPECT_EQ(one.labels.labels, two.labels.labels);
}

// A cube that was fitted to the whole scene holds for every camera.
TEST_F(LightOnMapTest, AMapIsTakenAsItIs) {
  SceneView seen(test::lent(device()), openScene("atrium"), 64, 64);
  ShadowPasses passes(seen);
  MapSetup setup = smallSetup();
  setup.receiversW.emplace();
  const Method method = atDefaults(findBias("constant"), seen);
  auto before = std::make_unique<LightOnMap>(seen, passes, cubeParameterization(), setup);
  const Occluders* map = &before->occluders();
  Camera camera = seen.camera();
  camera.worldFromEye[3] += glm::vec4(0.5f, 0.25f, -0.5f, 0.0f);
  seen.lookFrom(camera);
  LightOnMap after(seen, passes, cubeParameterization(), setup), anew(seen, passes, cubeParameterization(), setup);
  after.takeMapOf(*before);
  before.reset();
  EXPECT_EQ(&after.occluders(), map);
  EXPECT_EQ(after.judge(method).verdicts, anew.judge(method).verdicts);
}

// What depends on the camera alone is found once for all lights, and a ground truth once for all maps that take a light
// alike: a spot map of a point light traces one to aim by, which is the cube's, and one in its cone.
TEST_F(LightOnMapTest, MapsAndLightsShareWhatIsTheSame) {
  const SceneView seen(test::lent(device()), openScene("atrium"), 64, 64);
  ShadowPasses passes(seen);
  const Light* lamp = firstLightFor(seen.scene(), cubeParameterization());
  ASSERT_NE(lamp, nullptr);
  const LightOnMap cube(seen, passes, cubeParameterization(), *lamp, smallSetup());
  const LightOnMap paraboloid(seen, passes, paraboloidParameterization(), *lamp, smallSetup());
  const LightOnMap volume(seen, passes, volumeParameterization(), *lamp, smallSetup());
  EXPECT_EQ(seen.groundTruths().tracedCount(), 0u);
  EXPECT_GT(cube.receivers().scored, 1000u);
  EXPECT_EQ(&cube.groundTruth(), &paraboloid.groundTruth());
  EXPECT_EQ(&cube.groundTruth(), &volume.groundTruth());
  EXPECT_EQ(seen.groundTruths().tracedCount(), 1u);

  const LightOnMap spot(seen, passes, spotParameterization(), *lamp, smallSetup());
  EXPECT_EQ(seen.groundTruths().tracedCount(), 1u);  // aimed by the cube's
  EXPECT_NE(&spot.groundTruth(), &cube.groundTruth());
  EXPECT_EQ(seen.groundTruths().tracedCount(), 2u);
  Light other = *lamp;
  other.name = "other";
  other.positionW.y *= 0.5f;
  const LightOnMap elsewhere(seen, passes, cubeParameterization(), other, smallSetup());
  EXPECT_NE(elsewhere.truth().litCount, cube.truth().litCount);
  EXPECT_EQ(seen.groundTruths().tracedCount(), 3u);
  EXPECT_EQ(&elsewhere.receivers().samples[0], &cube.receivers().samples[0]);
  EXPECT_EQ(&spot.receivers().samples[0], &cube.receivers().samples[0]);
}

TEST_F(LightOnMapTest, DrawingAgainGivesTheSameBits) {
  for (const Parameterization* parameterization : everyMap()) {
    LitMap map(device(), "contact", *parameterization, 64, smallSetup());
    const Occluders& occluders = map.lit.occluders();
    const std::vector<float> once = occluders.downloadDepth(device());
    EXPECT_LT(std::ranges::count(once, 1.0f), std::ssize(once)) << "nothing is drawn: " << parameterization->name();
    EXPECT_GT(map.lit.redraw(), 0.0);
    EXPECT_EQ(occluders.downloadDepth(device()), once) << parameterization->name();
    EXPECT_EQ(&map.lit.occluders(), &occluders);
    EXPECT_EQ(occluders.bits() != nullptr, parameterization == &volumeParameterization());
    EXPECT_TRUE(occluders.downloadSecondDepth(device()).empty());
  }
}

TEST_F(LightOnMapTest, DrawingAgainReplacesWhatWasThere) {
  LitMap map(device(), "contact", volumeParameterization(), 64, smallSetup());
  const gpu::Buffer& bits = *map.lit.occluders().bits();
  const auto once = gpu::downloadAs<uint32_t>(device(), bits);
  gpu::Commands commands(device(), "garbage");
  commands.fill(bits, 0xdeadbeefu);
  commands.submitAndWait();
  EXPECT_NE(gpu::downloadAs<uint32_t>(device(), bits), once);
  map.lit.redraw();
  EXPECT_EQ(gpu::downloadAs<uint32_t>(device(), bits), once);
}

TEST_F(LightOnMapTest, WhatABiasReadsIsDrawnForIt) {
  LitMap map(device(), "contact", spotParameterization(), 64, smallSetup());
  map.judge("dual");
  const Occluders& two = map.lit.occluders(findBias("dual").channels);
  EXPECT_NE(&two, &map.lit.occluders());
  const std::vector<float> first = two.downloadDepth(device()), second = two.downloadSecondDepth(device());
  EXPECT_EQ(first, map.lit.occluders().downloadDepth(device()));
  ASSERT_EQ(second.size(), first.size());
  for (size_t i = 0; i < first.size(); ++i) ASSERT_TRUE(second[i] > first[i] || first[i] == 1.0f) << i;
}

// Agreeing is to say what the truth says; wrong one way round or the other are different labels.
TEST_F(LightOnMapTest, LabelsFollowFromVerdictsAndTruth) {
  for (const Parameterization* parameterization : everyMap()) {
    LitMap map(device(), "contact", *parameterization, 96, smallSetup());
    for (const char* bias : {"none", "constant"}) {
      const LabelledResult result = map.judge(bias);
      size_t wrong = 0;
      for (size_t i = 0; i < result.verdicts.size(); ++i) {
        const Label label = result.labels.labels[i];
        const bool scored = map.lit.receivers().states[i] == PixelState::Scored;
        ASSERT_EQ(label == Label::NotScored, !scored);
        if (!scored) continue;
        const bool lit = map.lit.truth().lit[i] != 0;
        if (std::ranges::find(result.edgeOn, i) == result.edgeOn.end()) {
          ASSERT_EQ(result.verdicts[i] == Verdict::Shadow, result.visibility[i] == 0.0f);
        }
        ASSERT_EQ(label == Label::Agree, result.verdicts[i] == (lit ? Verdict::Lit : Verdict::Shadow));
        if (label == Label::Acne || label == Label::EdgeShadow) {
          ASSERT_TRUE(lit);
        }
        if (label == Label::Leak || label == Label::EdgeLight) {
          ASSERT_FALSE(lit);
        }
        wrong += label != Label::Agree ? 1 : 0;
      }
      EXPECT_GT(wrong, 20u) << parameterization->name() << " " << bias;
      EXPECT_EQ(result.visibility, map.lit.visibility(atDefaults(findBias(bias), map.seen)));
    }
  }
}

// The texel that decided a pixel is the one that the pixel's point falls into, but for rounding at its border, and its
// ray passes the point within a texel's reach.
TEST_F(LightOnMapTest, ThePixelsTexelRayGoesThroughItsTexel) {
  for (const Parameterization* parameterization : everyMap()) {
    LitMap map(device(), "contact", *parameterization, 64, smallSetup());
    const FittedMap& fitted = map.lit.fitted();
    size_t asked = 0;
    for (const glsl::PixelDiagnosis& pixel : map.lit.diagnose(atDefaults(findBias("none"), map.seen))) {
      if (verdictOf(pixel) != Verdict::Lit && verdictOf(pixel) != Verdict::Shadow) continue;
      const RayD ray = texelRayW(fitted, pixel.texel);
      const double farAway = 0.5 * static_cast<double>(map.seen.sceneScale());
      const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(ray.origin + ray.dir * farAway));
      const glsl::MapPoint point = glsl::mapProject(fitted.map, posL);
      ASSERT_EQ(point.slice, glsl::unpackSlice(pixel.texel)) << parameterization->name();
      const glm::vec2 center = glsl::mapTexelCenter(fitted.map, glsl::unpackTexel(pixel.texel));
      ASSERT_LT(glm::length((point.uv - center) * glsl::mapTexelCounts(fitted.map)), 0.05f) << parameterization->name();
      ++asked;
    }
    EXPECT_GT(asked, 500u) << parameterization->name();
  }
}

TEST_F(LightOnMapTest, AnotherMapOfItSharesItsTruth) {
  LitMap map(device(), "contact", cubeParameterization(), 64, smallSetup());
  LightOnMap half(map.lit, {.side = 32});
  EXPECT_EQ(&half.groundTruth(), &map.lit.groundTruth());
  EXPECT_EQ(half.fitted().map.width, 32);
  EXPECT_EQ(half.occluders().downloadDepth(device()).size() * 4, map.lit.occluders().downloadDepth(device()).size());
}

TEST_F(LightOnMapTest, AMapMayEncloseWhatTheCameraDoesNotSee) {
  const LitMap seen(device(), "atrium", spotParameterization(), 64, {.side = 64});
  const LitMap whole(device(), "atrium", spotParameterization(), 64,
                     {.side = 64, .receiversW = std::vector<glm::dvec3>()});
  EXPECT_GT(whole.lit.fitted().zFar, seen.lit.fitted().zFar);
}

TEST_F(LightOnMapTest, ExposureMakesATypicalLitSurfaceThreeQuarters) {
  LitMap sun(device(), "lshape", directionalParameterization(), 64, smallSetup());
  EXPECT_NEAR(sun.lit.exposure().lightColor.x, 0.75f, 1e-6f);
  const std::vector<float> dark(64 * 64, 0.0f), lit(64 * 64, 1.0f);
  const ImageF ambient = sun.lit.radiance(dark), bright = sun.lit.radiance(lit);
  for (size_t i = 0; i < bright.values.size(); ++i) ASSERT_GE(bright.values[i], ambient.values[i]);
  EXPECT_NE(bright.values, ambient.values);
}

TEST_F(LightOnMapTest, ASceneWithoutACameraOrALightIsRefusedByName) {
  Scene scene = openScene("lshape");
  const auto messageOf = [&](const std::function<void()>& work) -> std::string {
    try {
      work();
    } catch (const WorldError& error) {
      return error.what();
    }
    return "";
  };
  scene.lights.clear();
  const SceneView seen(test::lent(device()), scene, 32, 32);
  ShadowPasses passes(seen);
  EXPECT_NE(messageOf([&] {
              const LightOnMap lit(seen, passes, cubeParameterization(), smallSetup());
            }).find("has no light that a cube map"),
            std::string::npos);
  scene.cameras.clear();
  EXPECT_NE(messageOf([&] { const SceneView blind(test::lent(device()), scene, 32, 32); }).find("has no camera"),
            std::string::npos);
}

}  // namespace
}  // namespace gnomon
