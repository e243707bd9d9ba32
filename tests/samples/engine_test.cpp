// samples/engine, a renderer of its own: what it sees by Gnomon's maps is what Gnomon sees, pixel by pixel, of the same
// scene, light, camera and map; and a steady frame makes nothing and waits for nothing.
#include "base/file.h"
#include "gpu/device.h"
#include "judge/light_on_map.h"
#include "omni/caster_range.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "scene/gltf.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"
#include "vsv/media/media_pass.h"
#include "vsv/volume_parameterization.h"

#include <cstdlib>
#include <cstring>
#include <sstream>

#include <gtest/gtest.h>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

constexpr int kSide = 512;
const MapOptions kRange{kDepthRange(DepthEnds{.zNear = 0.1, .zFar = 12.0})};

class Engine : public ::testing::Test {
 protected:
  // Once for all tests of this process.
  static const std::filesystem::path& folder() {
    static const test::TemporaryFolder made;
    static const int result =
        std::system((test::inBuild("samples/engine/engine") + " --validation " + made.path().string() + " >" +
                     (made.path() / "out").string() + " 2>" + (made.path() / "err").string())
                        .c_str());
    if (result != 0) ADD_FAILURE() << readFile(made.path() / "err") << readFile(made.path() / "out");
    return made.path();
  }
  static const SceneView& seen() {
    static const SceneView view(gpu::Device::create({}), loadGltf(folder() / "room.gltf"), kSide, kSide);
    return view;
  }

  // Pixels whose visibility differs; those that see nothing are lit in both.
  static size_t different(const std::string& method, const Parameterization& map, const MapOptions& options,
                          const char* bias, size_t* shadowed = nullptr) {
    ShadowPasses passes(seen());
    LightOnMap lit(seen(), passes, map, {.side = 512, .options = options});
    const std::vector<float> expected = lit.visibility(atDefaults(findBias(bias), seen()));
    const std::string found = readFile(folder() / (method + ".visibility"));
    EXPECT_EQ(found.size(), expected.size());
    size_t wrong = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      wrong += (found[i] != 0) != (expected[i] > 0.5f) ? 1 : 0;
      if (shadowed != nullptr) *shadowed += found[i] == 0 ? 1 : 0;
    }
    return wrong;
  }
};

// Of a method that is equal to the pixel; how many are shadowed is there so that an empty picture is not.
void expectEqual(size_t differences, size_t shadowed) {
  EXPECT_EQ(differences, 0u);
  EXPECT_GT(shadowed, 10000u);
  EXPECT_LT(shadowed, 60000u);
}

TEST_F(Engine, CubeIsEqualToThePixel) {
  size_t shadowed = 0;
  const size_t differences = different("cube_adaptive", cubeParameterization(), kRange, "adaptive", &shadowed);
  expectEqual(differences, shadowed);
}

TEST_F(Engine, TwoLayersAreEqualToThePixel) {
  size_t shadowed = 0;
  const size_t differences = different("cube_dual", cubeParameterization(), kRange, "dual", &shadowed);
  expectEqual(differences, shadowed);
}

TEST_F(Engine, WitnessIsEqualToThePixel) {
  size_t shadowed = 0;
  const size_t differences = different("cube_witness", cubeParameterization(), kRange, "witness", &shadowed);
  expectEqual(differences, shadowed);
}

TEST_F(Engine, ParaboloidIsEqualToThePixel) {
  size_t shadowed = 0;
  const MapOptions options = kRange.with(kParaboloidAxisW(glm::dvec3(0, -1, 0)));
  const size_t differences =
      different("paraboloid_adaptive", paraboloidParameterization(), options, "adaptive", &shadowed);
  expectEqual(differences, shadowed);
}

const MapOptions kVolume{kVolumeSize({.alpha = 512, .theta = 512, .phi = 512}), kVolumeFit(VolumeFit::View)};

TEST_F(Engine, VolumeIsEqualToThePixel) {
  size_t shadowed = 0;
  const size_t differences = different("volume_fog", volumeParameterization(), kVolume, "adaptive", &shadowed);
  expectEqual(differences, shadowed);
}

// The renderer's image holds 16-bit floats.
TEST_F(Engine, FogIsThatOfTheLaboratory) {
  ShadowPasses passes(seen());
  LightOnMap lit(seen(), passes, volumeParameterization(), {.side = 512, .options = kVolume});
  const MediaLightSource lamp{.positionW = lit.light().positionW, .intensity = glm::vec3(40.0f)};
  MediaPass media(seen().device(), kSide, kSide);
  media.setMedium(seen().view(), {.sigmaS = glm::vec3(0.06f), .sigmaA = {}, .g = 0.2f, .reach = 20.0f});
  const Occluders& volume = lit.occluders();
  gpu::Commands commands(seen().device(), "fog");
  media.recordTable(commands, volume, lamp);
  commands.barrier("the running integral is written -> view rays read it");
  media.record(commands, seen().buffers(), seen().gbuffer(), volume, lamp, mediaMethod("runs"), false);
  commands.submitAndWait();
  const auto expected = gpu::downloadAs<glm::vec3>(seen().device(), media.inScattered());
  const std::string found = readFile(folder() / "volume_fog.scattered");
  ASSERT_EQ(found.size(), expected.size() * 8);
  size_t wrong = 0;
  float most = 0.0f;
  for (size_t i = 0; i < expected.size(); ++i) {
    uint32_t word = 0;
    std::memcpy(&word, found.data() + 8 * i, 4);
    const float red = glm::unpackHalf2x16(word).x;
    most = std::max(most, red);
    wrong += std::abs(red - expected[i].x) > 1e-3f * expected[i].x + 1e-6f ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(most, 0.01f);
}

// By rounding alone: a depth of 32 bits and normals of 16 are not the triangle itself.
TEST_F(Engine, ReceiversFromItsDepthBufferDifferInAFewPixels) {
  EXPECT_LE(different("cube_adaptive_depth", cubeParameterization(), kRange, "adaptive"), 20u);
}

// The same, and matrices of its own arithmetic: 24 bits of a corner's place.
TEST_F(Engine, AMapThatTheRendererDrawsDiffersInAFewPixels) {
  EXPECT_LE(different("cube_adaptive_own_draws", cubeParameterization(), kRange, "adaptive"), 40u);
}

// What its counts are of, at last: the exact shadow.
TEST_F(Engine, CountsAreThoseOfCompare) {
  const test::TemporaryFolder made;
  const std::string command = test::inBuild("gnomon") + " compare " + (folder() / "room.gltf").string() +
                              " --maps cube --map-size 512 --size 512 --biases adaptive,witness --depth-range 0.1,12"
                              " --repeats 1 --json " +
                              (made.path() / "results.json").string() + " >" + (made.path() / "table").string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto rows = nlohmann::json::parse(readFile(made.path() / "results.json")).at("rows");
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    const std::string bias = row.at("bias");
    ShadowPasses passes(seen());
    LightOnMap lit(seen(), passes, cubeParameterization(), {.side = 512, .options = kRange});
    const LabelledResult result = lit.judge(atDefaults(findBias(bias), seen()));
    // Judged on what the renderer saw.
    const std::string found = readFile(folder() / ("cube_" + bias + ".visibility"));
    std::vector<Verdict> verdicts = result.verdicts;
    for (size_t i = 0; i < verdicts.size(); ++i)
      if (verdicts[i] == Verdict::Lit || verdicts[i] == Verdict::Shadow)
        verdicts[i] = found[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    for (const size_t i : result.edgeOn) verdicts[i] = result.verdicts[i];
    const std::vector<glsl::PixelDiagnosis> texels = lit.diagnose(atDefaults(findBias(bias), seen()));
    const LabelImage labels = labelPixels(seen().tracer(), lit.light(), lit.receivers(), lit.truth(), verdicts,
                                          [&](size_t pixel) { return texelRayW(lit.fitted(), texels[pixel].texel); });
    EXPECT_EQ(labels.count(Label::Acne), row.at("acne").get<size_t>()) << bias;
    EXPECT_EQ(labels.count(Label::Leak), row.at("leak").get<size_t>()) << bias;
    EXPECT_EQ(labels.count(Label::Agree), row.at("agree").get<size_t>()) << bias;
    EXPECT_GT(labels.count(Label::Agree), 100000u);
  }
}

// The validation layers have said nothing (the program's exit code), and the table's last columns are Vulkan's calls.
TEST_F(Engine, SteadyFramesMakeNothingAndWaitForNothing) {
  std::istringstream lines(readFile(folder() / "out"));
  std::string line;
  std::getline(lines, line);
  int methods = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string name;
    double number[5];
    int submits = -1, waits = -1, allocations = -1, objects = -1;
    words >> name;
    for (double& value : number) words >> value;
    words >> submits >> waits >> allocations >> objects;
    EXPECT_EQ(submits, 0) << line;
    EXPECT_EQ(waits, 0) << line;
    EXPECT_EQ(allocations, 0) << line;
    EXPECT_EQ(objects, 0) << line;
    ++methods;
  }
  EXPECT_EQ(methods, 7);
}

}  // namespace
}  // namespace gnomon
