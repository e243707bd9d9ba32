// Files from the field and what must come of them: small cases that once went wrong (from public bug reports, with the
// right counts), scenes at any scale and place, and everything a person may have in a folder.

#include "base/image.h"

#include "cli_fixture.h"

#include "tests/base/places.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Counts {
  uint64_t scored = 0, lit = 0, acne = 0, leak = 0;
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.scored << " scored, " << c.lit << " lit, " << c.acne << " acne, " << c.leak << " leak";
}

class InputsTest : public test::CliTest {
 protected:
  // Of every light asked for, one after the other.
  std::vector<Counts> compare(const fs::path& scene, const std::string& flags = "",
                              const std::string& bias = "adaptive") const {
    const test::Result result = run(
        "compare '" + scene.string() +
        "' --size 256 --map-size 512 --maps cube --repeats 1 --quiet --json @/r.json --biases " + bias + " " + flags);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    if (result.exitCode != 0) return {};
    told_ = result.err;
    const json results = json::parse(readFile(folder_ / "r.json"));
    std::vector<Counts> counts;
    for (const json& row : results.at("rows")) {
      if (row.at("sum")) continue;
      const json& truth = results.at("truths").at(counts.size());
      counts.push_back({row.at("scored"), truth.at("lit"), row.at("acne"), row.at("leak")});
    }
    return counts;
  }

  static fs::path caseFile(const std::string& name) { return fs::path(test::inSource("../shared/cases")) / name; }

  // A floor with a box on it and a sheet in the air, times `scale`, moved by `offset` (both exact in floats).
  fs::path yard(double scale, double offset) const {
    std::vector<float> positions;
    std::vector<uint16_t> indices;
    const auto quad = [&](std::array<std::array<double, 3>, 4> corners) {
      const uint16_t first = static_cast<uint16_t>(positions.size() / 3);
      for (const auto& corner : corners)
        for (int axis = 0; axis < 3; ++axis)
          positions.push_back(static_cast<float>(corner[axis] * scale + (axis == 1 ? 0.0 : offset)));
      for (const int k : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<uint16_t>(first + k));
    };
    quad({{{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}});
    quad({{{-1, 1.5, 1}, {1, 1.5, 1}, {1, 1.75, -1}, {-1, 1.75, -1}}});
    quad({{{-3, 0, -2}, {-2, 0, -2}, {-2, 2, -2}, {-3, 2, -2}}});
    std::string bytes(reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float));
    const size_t vertexBytes = bytes.size();
    bytes.append(reinterpret_cast<const char*>(indices.data()), indices.size() * sizeof(uint16_t));
    writeTextFile(folder_ / "yard.bin", bytes);
    const json document = {
        {"asset", {{"version", "2.0"}}},
        {"scenes", {{{"nodes", {0, 1}}}}},
        {"nodes",
         {{{"mesh", 0}},
          {{"name", "lamp"},
           {"translation", {1.25 * scale + offset, 4 * scale, 1.5 * scale + offset}},
           {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}}},
        {"extensionsUsed", {"KHR_lights_punctual"}},
        {"extensions", {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 100.0}}}}}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
        {"buffers", {{{"byteLength", bytes.size()}, {"uri", "yard.bin"}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", vertexBytes}},
          {{"buffer", 0}, {"byteOffset", vertexBytes}, {"byteLength", bytes.size() - vertexBytes}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", positions.size() / 3}, {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", 5123}, {"count", indices.size()}, {"type", "SCALAR"}}}}};
    writeTextFile(folder_ / "yard.gltf", document.dump());
    return folder_ / "yard.gltf";
  }

  mutable std::string told_;  // what the last comparison said on stderr
};

#define SKIP_WITHOUT_CASES() \
  if (!fs::is_directory(test::inSource("../shared/cases"))) GTEST_SKIP() << "skipped: ../shared/cases is not here"

TEST_F(InputsTest, HolesAndHiddenNodes) {
  SKIP_WITHOUT_CASES();
  EXPECT_EQ(compare(caseFile("mask_specgloss.gltf")), compare(caseFile("mask_plain.gltf")));
  EXPECT_EQ(compare(caseFile("mask_specgloss.gltf")).at(0).lit, 39249u);
  EXPECT_EQ(compare(caseFile("node_hidden.gltf")), compare(caseFile("node_without.gltf")));
  EXPECT_EQ(compare(caseFile("node_hidden.gltf")).at(0).lit, 38698u);
  EXPECT_EQ(compare(caseFile("uv_without_buffer_view.gltf")), compare(caseFile("uv_plain.gltf")));
}

TEST_F(InputsTest, TwoLightsOfOneName) {
  SKIP_WITHOUT_CASES();
  const auto counts = compare(caseFile("one_light_two_nodes.gltf"), "--light all");
  EXPECT_EQ(counts, compare(caseFile("two_lights_distinct.gltf"), "--light all"));
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_EQ(counts[0].scored + counts[1].scored, 73675u);
}

TEST_F(InputsTest, ScenesOfAnySizeAndPlace) {
  SKIP_WITHOUT_CASES();
  EXPECT_EQ(compare(caseFile("yard_small.gltf")), compare(caseFile("yard.gltf")));
  EXPECT_EQ(compare(caseFile("yard_far.gltf")).at(0).acne, 9u);
  EXPECT_NE(told_.find("from its origin"), std::string::npos) << told_;
}

TEST_F(InputsTest, AScaleOfAnyPowerOfTwoGivesTheSameCounts) {
  const auto counts = compare(yard(1.0, 0.0));
  ASSERT_FALSE(counts.empty());
  EXPECT_GT(counts[0].lit, 1000u);
  EXPECT_LT(counts[0].lit, counts[0].scored);
  for (const int power : {-20, -11, -1, 7, 20}) EXPECT_EQ(compare(yard(std::ldexp(1.0, power), 0.0)), counts) << power;
}

TEST_F(InputsTest, APlaceFarFromTheOriginGivesTheSameCounts) {
  const auto counts = compare(yard(1.0, 0.0));
  // Up to where every corner is exact in a float.
  for (const double offset : {4096.0, 65536.0, 1048576.0}) EXPECT_EQ(compare(yard(1.0, offset)), counts) << offset;
}

TEST_F(InputsTest, ALampCloseToItsShade) {
  SKIP_WITHOUT_CASES();
  const auto counts = compare(caseFile("lamp_shade_20m.gltf"));
  EXPECT_EQ(counts.at(0).leak, 0u);
  // A shade 2 cm below the lamp in a scene of 2.8 km: nearer than 1e-5 of the diagonal.
  const auto large = compare(caseFile("lamp_shade_2km.gltf"), "", "none");
  EXPECT_EQ(large.at(0).scored - large.at(0).lit, 3648u);
  EXPECT_EQ(large.at(0).leak, 0u);
}

TEST_F(InputsTest, ALampInASurfaceIsTold) {
  SKIP_WITHOUT_CASES();
  compare(caseFile("lamp_flush.gltf"));
  EXPECT_NE(told_.find("light 'lamp' lies in the surface of"), std::string::npos) << told_;
  EXPECT_EQ(compare(caseFile("lamp_hair_below.gltf")).at(0).lit, 43814u);
  EXPECT_EQ(told_, "");
}

TEST_F(InputsTest, APlusIsAPlus) {
  SKIP_WITHOUT_CASES();
  const test::Result info = run("info " + (caseFile("uri_plus") / "plus.gltf").string());
  EXPECT_NE(info.out.find("1.5,"), std::string::npos) << info.out;
}

TEST_F(InputsTest, ALightIsNamedByPathNumberOrPlace) {
  const fs::path scene = yard(1.0, 0.0);
  const auto counts = compare(scene);
  EXPECT_EQ(compare(scene, "--light lamp"), counts);
  EXPECT_EQ(compare(scene, "--light '#0'"), counts);
  EXPECT_EQ(compare(scene, "--light lamp@1.25,4,1.5"), counts);
  EXPECT_EQ(compare(scene, "--light 1.25,4,1.5"), counts);
  EXPECT_NE(compare(scene, "--light lamp@-2,3,0"), counts);
  // Moved or not, a light keeps its power.
  const auto radiance = [&](const std::string& flags, const std::string& name) {
    const test::Result result =
        run("fog '" + scene.string() + "' --size 32 --vsv-size 64x64x128 --quiet -o @/" + name + ".exr " + flags);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return readImage(folder_ / (name + ".exr")).values;
  };
  const std::vector<float> lamp = radiance("", "lamp");
  EXPECT_TRUE(radiance("--light 1.25,4,1.5", "placed") == lamp);
  EXPECT_TRUE(radiance("--light lamp@1.25,4,1.5", "moved") == lamp);
  EXPECT_TRUE(radiance("--intensity 100", "same") == lamp);
  EXPECT_FALSE(radiance("--intensity 50", "dim") == lamp);
}

}  // namespace
}  // namespace gnomon
