// A user's own bias: what its file says of itself, that it is what runs, and that a mistake in it is told by
// file and line.
#include "shadow/user_bias.h"
#include "base/error.h"
#include "base/file.h"
#include "map_fixture.h"
#include "tests/base/temporary_folder.h"

namespace gnomon {
namespace {

constexpr const char* kConstant = R"(
GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, params.userKnob);
}
)";

class UserBiasTest : public gpu::GpuTest {
 protected:
  std::unique_ptr<const UserBias> load(const std::string& text, const char* name = "mine.glsl") {
    writeTextFile(folder_.path() / name, text);
    return loadUserBias(folder_.path() / name);
  }

  void expectMistake(const std::string& text, const std::string& what) {
    try {
      load(text);
      FAIL() << "no error for: " << text;
    } catch (const WorldError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }

  std::vector<float> visibility(const test::Rendered& r, const BiasMethod& method, const glsl::BiasParams& params) {
    const auto image = test::draw(device(), r, method.content, CullMode::Solids);
    VisibilityPass pass(device(), r.view.width, r.view.height);
    pass.setUniforms(shadeUniforms(r.view, r.light, params));
    gpu::Commands commands(device(), "visibility");
    pass.record(commands, r.buffers, *r.gbuffer, *image, method, false);
    commands.submitAndWait();
    return gpu::downloadAs<float>(device(), pass.visibility());
  }

  test::TemporaryFolder folder_;
  std::vector<std::unique_ptr<const UserBias>> kept_;
};

TEST_F(UserBiasTest, SaysWhatItIs) {
  const auto bias = load(std::string("//! name: my-own\n//! sentence: It tries.\n//! layers: 2\n") +
                         "//! knob: reach texels 0 8 1.5\n" + kConstant);
  EXPECT_STREQ(bias->method.name, "my-own");
  EXPECT_STREQ(bias->method.sentence, "It tries.");
  EXPECT_EQ(bias->method.content, MapContent::TwoLayers);
  ASSERT_EQ(bias->method.knobs.size(), 1u);
  EXPECT_STREQ(bias->method.knobs[0].name, "reach");
  EXPECT_EQ(bias->method.knobs[0].unit, Unit::Texels);
  EXPECT_EQ(bias->method.knobs[0].upper, 8.0f);
  EXPECT_EQ(bias->method.knobs[0].defaultValue, 1.5f);
  EXPECT_FALSE(bias->method.knobs[0].defaultOfSceneScale);
  EXPECT_STREQ(load(kConstant, "other.glsl")->method.name, "other");
}

TEST_F(UserBiasTest, MistakesNameFileAndLine) {
  expectMistake("\n//! nmae: x\n", "mine.glsl:2: ");
  expectMistake("//! layers: 3\n", "write 1, 2 or back");
  expectMistake("//! knob: a feet 0 1 0.5\n", "'feet' is no unit");
  expectMistake("//! knob: a metres 1 0 0.5\n", "mine.glsl:1: the knob is not understood");
  expectMistake("//! knob: a metres 0 1\n", "the knob is not understood");
  expectMistake("//! name: constant\n", "built-in bias");
  expectMistake("//! name: ../x\n", "cannot name files");
  EXPECT_THROW(loadUserBias(folder_.path() / "absent.glsl"), WorldError);
}

TEST_F(UserBiasTest, ItIsWhatRuns) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 128, 64, CullMode::Solids);
  glsl::BiasParams params = defaultBiasParams(r.fitted.map.sceneScale);
  for (const float offset : {0.0f, 0.02f, 0.3f}) {
    params.constantOffset = params.userKnob = offset;
    EXPECT_EQ(visibility(r, load(kConstant)->method, params), visibility(r, findBias("constant"), params)) << offset;
  }
}

// Two files in one pass: each runs its own.
TEST_F(UserBiasTest, TwoOfThemAreTwo) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 64, 64, CullMode::Solids);
  VisibilityPass pass(device(), r.view.width, r.view.height);
  pass.setUniforms(shadeUniforms(r.view, r.light, {}));
  const std::string signature = "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap)";
  for (const char* answer : {"true", "false"}) {
    kept_.push_back(load(signature + " { return " + answer + "; }"));
    gpu::Commands commands(device(), "visibility");
    pass.record(commands, r.buffers, *r.gbuffer, *r.image, kept_.back()->method, false);
    commands.submitAndWait();
    const auto seen = gpu::downloadAs<float>(device(), pass.visibility());
    size_t lit = 0;
    for (size_t i = 0; i < seen.size(); ++i)
      lit += r.receivers.states[i] == PixelState::Scored && seen[i] == 1.0f ? 1 : 0;
    if (answer == std::string("true"))
      EXPECT_EQ(lit, r.receivers.scored);
    else
      EXPECT_LT(lit, r.receivers.scored / 2);  // what texels without a surface light
  }
}

TEST_F(UserBiasTest, WhatDoesNotCompileNamesFileAndLine) {
  const test::Rendered r = test::render(device(), "contact", spotParameterization(), 32, 32, CullMode::Solids);
  const auto bias = load(
      "\n\nbool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n  return "
      "nonsense;\n}\n");
  try {
    visibility(r, bias->method, {});
    FAIL();
  } catch (const WorldError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(bias->path + ":4:"), std::string::npos) << message;
    EXPECT_NE(message.find("nonsense"), std::string::npos) << message;
  }
}

TEST_F(UserBiasTest, TheSampleKeepsPlanesClean) {
  const auto sample = loadUserBias(std::filesystem::path(GNOMON_TEST_DIR) / "../../samples/my_bias.glsl");
  const test::Rendered r = test::render(device(), "tilted-planes", spotParameterization(), 256, 256, CullMode::Solids);
  glsl::BiasParams params = defaultBiasParams(r.fitted.map.sceneScale);
  params.userKnob = sample->method.knobs.front().defaultValue;
  const std::vector<float> seen = visibility(r, sample->method, params);
  const std::vector<float> adaptive = visibility(r, findBias("adaptive"), params);
  size_t different = 0;
  for (size_t i = 0; i < seen.size(); ++i) different += seen[i] != adaptive[i] ? 1 : 0;
  EXPECT_LT(different, seen.size() / 1000);
}

}  // namespace
}  // namespace gnomon
