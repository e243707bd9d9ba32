// Light shafts run through the lab: their errors, their files, and a reference that is traced once.
#include "lab/fog/fog.h"
#include "vsv/volume_parameterization.h"

#include "base/error.h"
#include "base/file.h"
#include "lab/compare/results.h"
#include "lab/core/maps.h"
#include "lab/fog/fog_reference.h"
#include "lab/fog/fog_report.h"
#include "lab/page/report.h"
#include "tests/base/temporary_folder.h"

#include <cstdlib>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class FogTest : public ::testing::Test {
 protected:
  FogTest() { setenv("GNOMON_CACHE_DIR", (folder_.path() / "cache").c_str(), 1); }
  ~FogTest() override { EXPECT_TRUE(messages_.empty()) << messages_.front(); }

  Session open(const SetupOptions& setup) { return {{.validation = true, .messageSink = &messages_}, setup}; }

  static FogOptions options() {
    FogOptions options{.integrators = {&findIntegrator("runs"), &findIntegrator("bits"), &findIntegrator("popcount"),
                                       &findIntegrator("march")},
                       .steps = {8, 64},
                       .marchMap = parseMaps("cube").front(),
                       .mapSide = 512,
                       .truth = true,
                       .repeats = 1};
    options.map.set(kVolumeSize({.alpha = 256, .theta = 256, .phi = 256}));
    return options;
  }

  // How many references there are on disk.
  size_t keptCount() const {
    const fs::path kept = folder_.path() / "cache" / "media";
    if (!fs::exists(kept)) return 0;
    return static_cast<size_t>(std::distance(fs::directory_iterator(kept), fs::directory_iterator()));
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> messages_;
};

TEST_F(FogTest, BitsComeCloserThanAMarchAndFilesSaySo) {
  const Session session = open({.scene = "grate", .size = "64x48"});
  FogOptions how = options();
  how.outDir = folder_.path() / "out";
  const FogResult result = runFog(session, how);
  ASSERT_EQ(result.rows.size(), 5u);
  const auto& [runs, bits, popcount, march8, march64] =
      std::tie(result.rows[0], result.rows[1], result.rows[2], result.rows[3], result.rows[4]);
  EXPECT_LT(*runs.relRmse99, 0.03);
  EXPECT_NEAR(*runs.relRmse, *bits.relRmse, 1e-3);
  EXPECT_LT(*runs.relRmse99, *popcount.relRmse99);
  EXPECT_LT(*march64.relRmse99, *march8.relRmse99);
  EXPECT_LT(*runs.relRmse99, *march8.relRmse99);
  for (const MediaRow& row : result.rows) {
    EXPECT_LE(*row.relRmse99, *row.relRmse);
    EXPECT_GT(row.integrateMs, 0.0);
    EXPECT_EQ(row.tableMs > 0.0, row.integrator != "march");
    EXPECT_EQ(row.isBaseline, row.integrator == "march");
  }
  EXPECT_EQ(result.equalTerms.size(), 3u * 4u);
  EXPECT_EQ(result.reference->atLimit, 0u);

  const std::string text = fogJson(session, how, result, "gnomon fog grate");
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("schema"), kResultsVersion);
  for (const char* key : {"gnomon", "scene", "camera", "lights", "medium", "reference", "media", "equal_terms"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const auto& row : json.at("media")) {
    for (const char* key : {"integrator", "steps", "rel_rmse", "rel_rmse_99", "flip", "build_ms", "integrate_ms",
                            "map_ms", "table_ms", "map", "params", "flicker"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_DOUBLE_EQ(row.at("build_ms").get<double>(),
                     row.at("map_ms").get<double>() + row.at("table_ms").get<double>());
    for (const auto& [kind, path] : row.at("pictures").items())
      EXPECT_TRUE(fs::exists(how.outDir / path.get<std::string>())) << path;
  }
  EXPECT_EQ(json.at("media")[4].at("steps"), 64);
  EXPECT_TRUE(json.at("media")[0].at("steps").is_null());
  // The EXR holds cd/m^2, unexposed.
  const ImageF exr = readImage(how.outDir / "media" / "runs.exr");
  ASSERT_EQ(exr.channels, 6);
  EXPECT_EQ(exr.at(10, 20)[3], result.inScattered[0].at(10, 20)[0]);
  EXPECT_EQ(exr.at(10, 20)[0], result.inScattered[0].at(10, 20)[0] + result.view.surface.at(10, 20)[0]);

  writeTextFile(how.outDir / "results.json", text);
  const std::string page = reportHtml(how.outDir);
  for (const char* part : {"march 64", "Compared with ray marching", "The reference", "data:image/png"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("cannot be read"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  const std::string table = fogTable(session, how, result);
  EXPECT_NE(table.find("reference: mean"), std::string::npos) << table;
}

// Nothing casts a shadow on what the camera looks at: every way must give the same.
TEST_F(FogTest, LightsAddUpInEveryWay) {
  const Session one = open({.scene = "contact", .light = "0.4,3,0.3", .size = "40"});
  FogOptions how = options();
  how.truth = false;
  how.medium.sigmaS = glm::vec3(0.1f, 0.2f, 0.3f);
  const FogResult single = runFog(one, how);
  ShadowPasses passes(one);
  Light twin = single.view.lights.front();
  const FogView both = lookIntoFog(one, passes, {twin, twin}, how.medium);
  const FogMethodOptions methods{
      .methods = single.methods, .marchMap = how.marchMap, .map = how.map, .mapSide = how.mapSide};
  const std::vector<FogMethodResult> doubled = runFogMethods(one, passes, both, methods);
  for (size_t r = 0; r < doubled.size(); ++r)
    for (size_t i = 0; i < doubled[r].inScattered.values.size(); ++i)
      ASSERT_EQ(doubled[r].inScattered.values[i], 2.0f * single.inScattered[r].values[i]);
  for (size_t i = 0; i < both.surface.values.size(); ++i)
    ASSERT_EQ(both.surface.values[i], 2.0f * single.view.surface.values[i]);
}

TEST_F(FogTest, AThickerMediumDimsWhatStandsInIt) {
  const Session session = open({.scene = "grate", .size = "32"});
  ShadowPasses passes(session);
  FogMedium thin{.sigmaS = glm::vec3(0.0f)}, thick{.sigmaS = glm::vec3(0.1f), .sigmaA = glm::vec3(0.0f, 0.1f, 0.0f)};
  const FogView clear = lookIntoFog(session, passes, fogLights(session), thin);
  const FogView foggy = lookIntoFog(session, passes, fogLights(session), thick);
  const Light& light = clear.lights.front();
  size_t lit = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const auto pixel = static_cast<size_t>(y * 32 + x);
      const glm::dvec3 posW = glm::dvec3(session.view().eyeW) + pixelRay(session.view(), x, y).dir * clear.ends[pixel];
      const double path = clear.ends[pixel] + glm::length(posW - glm::dvec3(light.positionW));
      for (int c = 0; c < 3; ++c) {
        const float before = clear.surface.at(x, y)[c], after = foggy.surface.at(x, y)[c];
        if (before > 0.0f) {
          // A surface seen at its triangle's very edge lies aside of the pixel's ray.
          EXPECT_NEAR(after / before, std::exp(-(c == 1 ? 0.2 : 0.1) * path), 1e-3);
          ++lit;
        }
      }
    }
  }
  EXPECT_GT(lit, 300u);
}

TEST_F(FogTest, AReferenceIsTracedOnceAndAgainWhereAnythingChanges) {
  const Session session = open({.scene = "grate", .size = "24x16"});
  ShadowPasses passes(session);
  const std::vector<Light> lights = fogLights(session);
  const FogView view = lookIntoFog(session, passes, lights, {});
  const MediaReferenceOptions how;
  EXPECT_FALSE(referenceFor(session, view, how, true).fromCache);
  const KeptReference kept = referenceFor(session, view, how, true);
  const KeptReference traced = referenceFor(session, view, how, false);
  EXPECT_TRUE(kept.fromCache);
  EXPECT_FALSE(traced.fromCache);
  EXPECT_EQ(keptCount(), 1u);
  EXPECT_EQ(kept.reference.inScattered.values, traced.reference.inScattered.values);
  EXPECT_EQ(kept.reference.rays, traced.reference.rays);
  EXPECT_EQ(kept.reference.worstChange, traced.reference.worstChange);

  const gpu::Hash128 key = referenceKey(session, view, how);
  const auto differs = [&](const char* what, const std::function<void(FogView&, MediaReferenceOptions&)>& change) {
    FogView other = view;
    MediaReferenceOptions otherHow = how;
    change(other, otherHow);
    EXPECT_NE(referenceKey(session, other, otherHow), key) << what;
  };
  differs("light", [](FogView& v, auto&) { v.exactLights[0].positionW.x += 1e-3; });
  differs("intensity", [](FogView& v, auto&) { v.exactLights[0].intensity.y *= 2.0; });
  differs("cone", [](FogView& v, auto&) { v.exactLights[0].cosCone = 0.5; });
  differs("lights", [](FogView& v, auto&) { v.exactLights.push_back(v.exactLights[0]); });
  differs("sigma", [](FogView& v, auto&) { v.model.sigmaA.z = 0.1; });
  differs("g", [](FogView& v, auto&) { v.model.g = -0.2; });
  differs("ends", [](FogView& v, auto&) { v.ends[5] *= 0.5; });
  differs("bound", [](FogView&, MediaReferenceOptions& o) { o.bound = 0.1; });
  differs("samples", [](FogView&, MediaReferenceOptions& o) { o.firstSamples = 16; });
  Camera camera = session.camera();
  camera.yFovRad *= 1.01f;
  EXPECT_NE(referenceKey(SceneView(session, camera), view, how), key);
  EXPECT_NE(referenceKey(open({.scene = "contact", .size = "24x16"}), view, how), key);
  EXPECT_EQ(referenceKey(session, view, how), key);
}

TEST_F(FogTest, ADamagedReferenceIsTracedAnew) {
  const Session session = open({.scene = "grate", .size = "8"});
  ShadowPasses passes(session);
  const FogView view = lookIntoFog(session, passes, fogLights(session), {});
  const MediaReference exact = referenceFor(session, view, {}, true).reference;
  const fs::path path = referenceFile(referenceKey(session, view, {}));
  const std::string whole = readFile(path);
  for (const size_t at : {size_t{1}, size_t{60}, whole.size() - 3}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    writeTextFile(path, damaged);
    const KeptReference again = referenceFor(session, view, {}, true);
    EXPECT_FALSE(again.fromCache) << at;
    EXPECT_EQ(again.reference.inScattered.values, exact.inScattered.values);
    EXPECT_EQ(readFile(path).size(), whole.size());
  }
  for (const size_t length : {size_t{0}, size_t{50}, whole.size() - 1}) {
    writeTextFile(path, whole.substr(0, length));
    EXPECT_FALSE(referenceFor(session, view, {}, true).fromCache) << length;
  }
  EXPECT_TRUE(referenceFor(session, view, {}, true).fromCache);
}

TEST_F(FogTest, AMovingLightFlickersLessInTheReferenceThanInAMarch) {
  const Session session = open({.scene = "grate", .size = "48x36"});
  FogOptions how = options();
  how.integrators = {&findIntegrator("runs"), &findIntegrator("march")};
  how.steps = {8};
  how.reference.bound = 0.01;
  how.motion = FogMotion{.frames = 3, .offsetW = {0.2f, 0.0f, 0.0f}};
  how.outDir = folder_.path() / "out";
  const FogResult result = runFog(session, how);
  EXPECT_GT(*result.rows[0].flicker, 0.0);
  EXPECT_LT(*result.rows[0].flicker, *result.rows[1].flicker);
  for (const char* name : {"runs", "march_8", "reference"})
    for (const char* frame : {"0000.png", "0002.png"})
      EXPECT_TRUE(fs::exists(how.outDir / "frames" / name / frame)) << name << frame;
  EXPECT_NE(result.motionNote.find("PNG"), std::string::npos);
  // The light has moved in the last frame, and not in the first.
  EXPECT_EQ(readFile(how.outDir / "frames" / "runs" / "0000.png"), readFile(how.outDir / "media" / "runs.beauty.png"));
  EXPECT_NE(readFile(how.outDir / "frames" / "runs" / "0000.png"),
            readFile(how.outDir / "frames" / "runs" / "0002.png"));
}

TEST_F(FogTest, ALightWithoutAPlaceIsRefused) {
  const Session session = open({.scene = "tilted-planes", .size = "8"});
  ASSERT_FALSE(session.scene().lights.empty());
  const Session atEye = open({.scene = "grate", .light = "0,1,5", .camera = "eye:0,1,5,target:0,0,0", .size = "8"});
  ShadowPasses passes(atEye);
  EXPECT_THROW(lookIntoFog(atEye, passes, fogLights(atEye), {}), WorldError);
}

}  // namespace
}  // namespace gnomon
