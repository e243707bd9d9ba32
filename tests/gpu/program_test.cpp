// Programs: dispatches that compute, and calls that are refused because they do not fit the shader.
#include "gpu/program.h"

#include "base/error.h"
#include "tests/gpu_fixture.h"

#include <numeric>

namespace gnomon::gpu {
namespace {

struct Push {
  uint32_t count;
  glm::vec3 factor;
};
static_assert(sizeof(Push) == 16);

constexpr uint32_t kCount = 128;  // two layers of 8 x 8 texels

class ProgramTest : public GpuTest {
 protected:
  ProgramTest() {
    std::vector<float> values(kCount);
    std::iota(values.begin(), values.end(), 0.0f);
    input_ = createBufferWith(device(), "input", values);
    output_ = Buffer(device(), {.name = "output", .size = kCount * sizeof(float)});
    image_ = Image(device(), {.name = "image",
                              .format = VK_FORMAT_R32_SFLOAT,
                              .width = 8,
                              .height = 8,
                              .layerCount = 2,
                              .array = true,
                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT});
  }

  // Fills the image with its texel numbers, then adds it up with the input.
  std::vector<float> run(const ComputeProgram& program) {
    const ComputeProgram numbers(device(), GNOMON_TEST_SHADER("write_texel_numbers.comp.glsl"));
    Commands commands(device(), "add");
    commands.dispatch(numbers, {8, 8, 2}, {}, {{0, image_}});
    commands.barrier("texel numbers written -> sum reads them");
    commands.dispatch(program, {kCount / 64, 1, 1}, asPush(Push{kCount, glm::vec3(0, 0, 10)}),
                      {{7, image_}, {0, input_}, {1, output_}, {2, image_}, {4, image_}});
    commands.submitAndWait();
    return downloadAs<float>(device(), output_);
  }

  Buffer input_, output_;
  Image image_;
};

TEST_F(ProgramTest, EveryKindOfBindingArrives) {
  const std::vector<float> results = run(ComputeProgram(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl")));
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(results[i], 13.0f * static_cast<float>(i)) << i;
}

TEST_F(ProgramTest, ASpecializationConstantReplacesItsDefault) {
  const std::vector<float> results =
      run(ComputeProgram(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"), {{.id = 3, .value = -5}}));
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(results[i], 7.0f * static_cast<float>(i)) << i;
}

TEST_F(ProgramTest, AProgramMoves) {
  ComputeProgram first(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  const ComputeProgram second = std::move(first);
  EXPECT_EQ(run(second)[5], 65.0f);
}

TEST_F(ProgramTest, AMissingBindingAbortsAndIsNamed) {
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  Commands commands(device(), "wrong");
  EXPECT_DEATH(
      commands.dispatch(program, {1, 1, 1}, asPush(Push{}), {{0, input_}, {1, output_}, {4, image_}, {7, image_}}),
      "add_texture.comp.glsl is given nothing for binding 2 against texture 'plain'");
}

TEST_F(ProgramTest, AnUnknownBindingAborts) {
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  Commands commands(device(), "wrong");
  EXPECT_DEATH(commands.dispatch(program, {1, 1, 1}, asPush(Push{}),
                                 {{0, input_}, {1, output_}, {2, image_}, {3, input_}, {4, image_}, {7, image_}}),
               "is given binding 3 against");
}

TEST_F(ProgramTest, ABindingGivenTwiceAborts) {
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  Commands commands(device(), "wrong");
  EXPECT_DEATH(commands.dispatch(program, {1, 1, 1}, asPush(Push{}),
                                 {{0, input_}, {1, output_}, {2, image_}, {2, image_}, {4, image_}, {7, image_}}),
               "is given 6 bindings, one of them twice against the 5");
}

TEST_F(ProgramTest, ABufferWhereAnImageBelongsAborts) {
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  Commands commands(device(), "wrong");
  EXPECT_DEATH(commands.dispatch(program, {1, 1, 1}, asPush(Push{}),
                                 {{0, input_}, {1, output_}, {2, image_}, {4, input_}, {7, image_}}),
               "is given buffer for binding 4 against texture 'sampled'");
}

TEST_F(ProgramTest, PushConstantsOfAnotherSizeAbort) {
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  Commands commands(device(), "wrong");
  const uint32_t tooLittle = 0;
  EXPECT_DEATH(commands.dispatch(program, {1, 1, 1}, asPush(tooLittle),
                                 {{0, input_}, {1, output_}, {2, image_}, {4, image_}, {7, image_}}),
               "add_texture.comp.glsl is given 4 bytes of push constants against the 16 bytes");
}

TEST_F(ProgramTest, AnEmptyProgramAborts) {
  const ComputeProgram empty;
  Commands commands(device(), "wrong");
  EXPECT_DEATH(commands.dispatch(empty, {1, 1, 1}, {}, {}), "program.pipeline");
}

TEST_F(ProgramTest, StagesThatDisagreeOnABindingAreRefused) {
  const ShaderSource vertex = inlineShader("t/a.vert.glsl",
                                           "layout(scalar, binding = 0) readonly buffer B { vec4 p[]; };\n"
                                           "void main() { gl_Position = p[gl_VertexIndex]; }\n");
  const ShaderSource fragment = inlineShader("t/a.frag.glsl",
                                             "layout(binding = 0) uniform texture2DArray t;\n"
                                             "layout(location = 0) out vec4 c;\n"
                                             "void main() { c = texelFetch(t, ivec3(0), 0); }\n");
  try {
    GraphicsProgram(
        device(),
        {.name = "disagree", .vertex = vertex, .fragment = fragment, .colorFormats = {VK_FORMAT_R32G32B32A32_SFLOAT}});
    FAIL() << "not refused";
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("disagree: binding 0"), std::string::npos) << error.what();
  }
}

TEST_F(ProgramTest, TooManyPushConstantsAreRefusedWithTheLimit) {
  const ShaderSource source = inlineShader("t/push.comp.glsl",
                                           "layout(local_size_x = 1) in;\n"
                                           "layout(scalar, push_constant) uniform P { float big[4096]; };\n"
                                           "layout(scalar, binding = 0) buffer B { float b[]; };\n"
                                           "void main() { b[0] = big[7]; }\n");
  try {
    ComputeProgram(device(), source);
    FAIL() << "not refused";
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("16384 bytes of push constants"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gnomon::gpu
