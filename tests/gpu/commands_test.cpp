// Command buffers: copies, fills, stages with their times, and the order that is asked of the caller.
#include "gpu/commands.h"

#include "tests/gpu_fixture.h"

#include <fmt/format.h>

namespace gnomon::gpu {
namespace {

class CommandsTest : public GpuTest {
 protected:
  // Keeps the device busy for some milliseconds.
  ComputeProgram busyProgram() {
    return ComputeProgram(device(), inlineShader("t/busy.comp.glsl",
                                                 "layout(local_size_x = 64) in;\n"
                                                 "layout(scalar, binding = 0) buffer B { uint v[]; };\n"
                                                 "void main() {\n"
                                                 "  uint x = gl_GlobalInvocationID.x;\n"
                                                 "  for (int i = 0; i < 2000; ++i) x = x * 1664525u + 1013904223u;\n"
                                                 "  v[gl_GlobalInvocationID.x] = x;\n"
                                                 "}\n"));
  }
};

TEST_F(CommandsTest, FillAndCopy) {
  const Buffer a(device(), {.name = "a", .size = 16});
  const Buffer b(device(), {.name = "b", .size = 16});
  Commands commands(device(), "copy");
  commands.fill(a, 0xabcd1234u);
  commands.fill(b, 7);
  commands.barrier("fill wrote -> copy reads");
  commands.copy(a, b, 8);
  commands.submitAndWait();
  EXPECT_EQ(downloadAs<uint32_t>(device(), b), (std::vector<uint32_t>{0xabcd1234u, 0xabcd1234u, 7, 7}));
}

TEST_F(CommandsTest, StagesHaveNamesAndPlausibleTimes) {
  const ComputeProgram program = busyProgram();
  const Buffer buffer(device(), {.name = "numbers", .size = 65536 * 4});
  const auto record = [&](Commands& commands) {
    for (const char* name : {"first", "second"}) {
      commands.beginStage(name);
      commands.dispatch(program, {1024, 1, 1}, {}, {{0, buffer}});
      commands.barrier("one dispatch -> the next");
      commands.endStage();
    }
    return commands.submitAndWait();
  };
  Commands cold(device(), "cold");  // compiles the pipeline
  record(cold);
  Commands warm(device(), "warm");
  const Submission submission = record(warm);
  ASSERT_EQ(submission.stages.size(), 2u);
  EXPECT_EQ(submission.stages[0].name, "first");
  EXPECT_EQ(submission.stages[1].name, "second");
  double sum = 0.0;
  for (const StageTime& stage : submission.stages) {
    EXPECT_GT(stage.gpuMs, 0.0) << stage.name;
    sum += stage.gpuMs;
  }
  EXPECT_GT(submission.wallMs, 0.0);
  EXPECT_LT(sum, submission.wallMs * 1.1 + 1.0);
}

TEST_F(CommandsTest, SixtyFourStagesFitAndOneMoreAborts) {
  Commands commands(device(), "many");
  for (int i = 0; i < 64; ++i) {
    commands.beginStage(fmt::format("stage {}", i).c_str());
    commands.endStage();
  }
  EXPECT_DEATH(commands.beginStage("one more"), "64 against 64");
  const Submission submission = commands.submitAndWait();
  ASSERT_EQ(submission.stages.size(), 64u);
  EXPECT_EQ(submission.stages[63].name, "stage 63");
}

TEST_F(CommandsTest, NothingRecordedIsNothingDone) {
  Commands commands(device(), "empty");
  EXPECT_TRUE(commands.submitAndWait().stages.empty());
  const Commands neverSubmitted(device(), "never submitted");
}

TEST_F(CommandsTest, CallsOutOfOrderAbort) {
  const Image image(device(), {.name = "target",
                               .format = VK_FORMAT_R32_SFLOAT,
                               .width = 4,
                               .height = 4,
                               .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  Commands stage(device(), "stage");
  stage.beginStage("open");
  EXPECT_DEATH(stage.beginStage("nested"), "inStage_");
  EXPECT_DEATH(stage.submitAndWait(), "inStage_");
  stage.endStage();
  stage.submitAndWait();
  EXPECT_DEATH(stage.submitAndWait(), "submitted_");
  Commands rendering(device(), "rendering");
  EXPECT_DEATH(rendering.draw(3, 1, 0, 0), "inRendering_");
  rendering.beginRendering({.colors = {{&image, {}}}});
  EXPECT_DEATH(rendering.barrier("inside a pass"), "inRendering_");
  rendering.endRendering();
  EXPECT_DEATH(rendering.beginRendering({.colors = {{&image, {}}}, .layer = 1}), "1 against 1");
}

}  // namespace
}  // namespace gnomon::gpu
