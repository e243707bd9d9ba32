// Rasterization into images, each against what the plane equation says of every texel.
#include "gpu/commands.h"
#include "tests/gpu_fixture.h"

#include <functional>

namespace gnomon::gpu {
namespace {

constexpr uint32_t kSize = 16;  // texels

using Positions = std::vector<glm::vec4>;

//  (-1,-1)-----+     The upper left half of the target: texel (x, y) is inside when x + y <= 15. The long edge
//     |  in  ./      runs half a texel beyond the diagonal, so that no texel centre lies on it. Depth is
//     |    ./        z0 + dz * (x + 0.5), in window coordinates.
//     +  ./
Positions halfTriangle(float z0, float dz = 0.0f) {
  const float beyond = 1.0f + 1.0f / kSize;
  return {{-1.0f, -1.0f, z0, 1.0f}, {beyond, -1.0f, z0 + dz * (kSize + 0.5f), 1.0f}, {-1.0f, beyond, z0, 1.0f}};
}

bool inHalf(uint32_t x, uint32_t y) {
  return x + y <= 15;
}

class RasterTest : public GpuTest {
 protected:
  Image makeImage(VkFormat format, uint32_t layerCount, VkImageUsageFlags usage) const {
    return Image(device(), {.name = "target",
                            .format = format,
                            .width = kSize,
                            .height = kSize,
                            .layerCount = layerCount,
                            .array = layerCount > 1,
                            .usage = usage});
  }
  Image colorImage(VkFormat format, uint32_t layerCount = 1) const {
    return makeImage(format, layerCount, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  }
  Image depthImage(uint32_t layerCount = 1) const {
    return makeImage(VK_FORMAT_D32_SFLOAT, layerCount, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  }
  Buffer positions(const Positions& values) const { return createBufferWith(device(), "positions", values); }

  // One pass: `record` binds and draws.
  void render(const RenderTargets& targets, const std::function<void(Commands&)>& record) const {
    Commands commands(device(), "render");
    commands.beginRendering(targets);
    record(commands);
    commands.endRendering();
    commands.submitAndWait();
  }

  const ShaderSource vertex_ = GNOMON_TEST_SHADER("draw_positions.vert.glsl");
  const ShaderSource color_ = GNOMON_TEST_SHADER("draw_color.frag.glsl");
};

TEST_F(RasterTest, ATriangleFillsColourAndDepth) {
  const Image color = colorImage(VK_FORMAT_R32G32B32A32_SFLOAT);
  const Image depth = depthImage();
  const GraphicsProgram program(device(), {.name = "colour and depth",
                                           .vertex = vertex_,
                                           .fragment = color_,
                                           .colorFormats = {VK_FORMAT_R32G32B32A32_SFLOAT},
                                           .depthFormat = VK_FORMAT_D32_SFLOAT});
  // The second triangle is nearer where x < 8, and fails the depth test elsewhere.
  Positions values = halfTriangle(0.5f);
  for (const glm::vec4& position : halfTriangle(0.25f, 1.0f / 32.0f)) values.push_back(position);
  const Buffer buffer = positions(values);
  const glm::vec4 red(1, 0, 0, 1), blue(0, 0, 1, 1);
  render({.colors = {{&color, VkClearColorValue{{9.0f, 9.0f, 9.0f, 9.0f}}}}, .depth = &depth, .clearDepth = 1.0f},
         [&](Commands& commands) {
           commands.bind(program, asPush(red), {{0, buffer}});
           commands.draw(3, 1, 0, 0);
           commands.bind(program, asPush(blue), {{0, buffer}});
           commands.draw(3, 1, 3, 0);
         });
  const auto colors = downloadAs<glm::vec4>(device(), color);
  const auto depths = downloadAs<float>(device(), depth);
  for (uint32_t y = 0; y < kSize; ++y) {
    for (uint32_t x = 0; x < kSize; ++x) {
      const size_t i = y * kSize + x;
      const float second = 0.25f + (static_cast<float>(x) + 0.5f) / 32.0f;
      const glm::vec4 expected = !inHalf(x, y) ? glm::vec4(9.0f) : second < 0.5f ? blue : red;
      EXPECT_EQ(colors[i], expected) << x << ", " << y;
      EXPECT_NEAR(depths[i], !inHalf(x, y) ? 1.0f : std::min(second, 0.5f), 1e-6f) << x << ", " << y;
    }
  }
}

// The program's first output is of another type than any target, and gone with the constant that decides it.
TEST_F(RasterTest, AColourTargetMayBeAbsentAndPushConstantsChangeBetweenDraws) {
  const Image color = colorImage(VK_FORMAT_R32G32B32A32_SFLOAT);
  const ShaderSource fragment = inlineShader("t/two_outputs.frag.glsl",
                                             "layout(constant_id = 0) const int kNumbers = 1;\n"
                                             "layout(location = 0) out uint number;\n"
                                             "layout(location = 1) out vec4 color;\n"
                                             "layout(scalar, push_constant) uniform Push { vec4 pushedColor; };\n"
                                             "void main() {\n"
                                             "  if (kNumbers == 1) number = 7u;\n"
                                             "  color = pushedColor;\n"
                                             "}\n");
  const GraphicsProgram program(device(), {.name = "second colour alone",
                                           .vertex = vertex_,
                                           .fragment = fragment,
                                           .specializations = {{.id = 0, .value = 0}},
                                           .colorFormats = {VK_FORMAT_UNDEFINED, VK_FORMAT_R32G32B32A32_SFLOAT}});
  Positions values = halfTriangle(0.5f);
  for (const glm::vec4& position : halfTriangle(0.5f))
    values.emplace_back(-position.x, -position.y, position.z, 1.0f);  // the lower right half
  const Buffer buffer = positions(values);
  const glm::vec4 red(1, 0, 0, 1), blue(0, 0, 1, 1);
  render({.colors = {{}, {&color, VkClearColorValue{{9.0f, 9.0f, 9.0f, 9.0f}}}}}, [&](Commands& commands) {
    commands.bind(program, asPush(red), {{0, buffer}});
    commands.draw(3, 1, 0, 0);
    commands.push(program, asPush(blue));
    commands.draw(3, 1, 3, 0);
  });
  const auto colors = downloadAs<glm::vec4>(device(), color);
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) EXPECT_EQ(colors[y * kSize + x], x + y >= 15 ? blue : red) << x << ", " << y;
}

TEST_F(RasterTest, WhatIsNotClearedIsKept) {
  const Image color = colorImage(VK_FORMAT_R32G32B32A32_SFLOAT);
  const GraphicsProgram program(
      device(),
      {.name = "keep", .vertex = vertex_, .fragment = color_, .colorFormats = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  const Buffer buffer = positions(halfTriangle(0.5f));
  const glm::vec4 red(1, 0, 0, 1);
  render({.colors = {{&color, VkClearColorValue{{9.0f, 9.0f, 9.0f, 9.0f}}}}}, [](Commands&) {});
  render({.colors = {{&color, {}}}}, [&](Commands& commands) {
    commands.bind(program, asPush(red), {{0, buffer}});
    commands.draw(3, 1, 0, 0);
  });
  const auto colors = downloadAs<glm::vec4>(device(), color);
  EXPECT_EQ(colors[0], red);
  EXPECT_EQ(colors[kSize * kSize - 1], glm::vec4(9.0f));
}

TEST_F(RasterTest, DepthOnlyDrawsToTheNamedLayerAndNoOther) {
  const Image depth = depthImage(4);
  const GraphicsProgram program(device(),
                                {.name = "depth only", .vertex = vertex_, .depthFormat = VK_FORMAT_D32_SFLOAT});
  const Buffer buffer = positions(halfTriangle(0.5f));
  for (uint32_t layer = 0; layer < 4; ++layer)
    render({.depth = &depth, .clearDepth = 1.0f, .layer = layer}, [&](Commands& commands) {
      if (layer != 2) return;
      commands.bind(program, {}, {{0, buffer}});
      commands.draw(3, 1, 0, 0);
    });
  const auto depths = downloadAs<float>(device(), depth);
  ASSERT_EQ(depths.size(), 4 * kSize * kSize);
  for (uint32_t layer = 0; layer < 4; ++layer)
    for (uint32_t y = 0; y < kSize; ++y)
      for (uint32_t x = 0; x < kSize; ++x)
        ASSERT_EQ(depths[(layer * kSize + y) * kSize + x], layer == 2 && inHalf(x, y) ? 0.5f : 1.0f)
            << layer << ": " << x << ", " << y;
}

// Two views within the view volume, all that lavapipe gets right: see RenderTargets::viewMask. The long edge
// runs half a texel short of the diagonal.
TEST_F(RasterTest, MultiviewDrawsEveryLayerInOnePass) {
  const Image depth = depthImage(2);
  const GraphicsProgram program(device(), {.name = "multiview",
                                           .vertex = GNOMON_TEST_SHADER("draw_view_positions.vert.glsl"),
                                           .depthFormat = VK_FORMAT_D32_SFLOAT,
                                           .viewMask = 0b11});
  const float shortOf = 1.0f - 1.0f / kSize;
  const Buffer buffer =
      positions({{-1.0f, -1.0f, 0.125f, 1.0f}, {shortOf, -1.0f, 0.125f, 1.0f}, {-1.0f, shortOf, 0.125f, 1.0f}});
  render({.depth = &depth, .clearDepth = 1.0f, .viewMask = 0b11}, [&](Commands& commands) {
    commands.bind(program, {}, {{0, buffer}});
    commands.draw(3, 1, 0, 0);
  });
  const auto depths = downloadAs<float>(device(), depth);
  for (uint32_t layer = 0; layer < 2; ++layer)
    for (uint32_t y = 0; y < kSize; ++y)
      for (uint32_t x = 0; x < kSize; ++x) {
        const bool inside = (layer == 0 ? x : kSize - 1 - x) + y <= 14;
        const float expected = inside ? 0.125f + 0.25f * static_cast<float>(layer) : 1.0f;
        ASSERT_EQ(depths[(layer * kSize + y) * kSize + x], expected) << layer << ": " << x << ", " << y;
      }
}

TEST_F(RasterTest, MinBlendKeepsTheNearestWithoutADepthBuffer) {
  const Image color = colorImage(VK_FORMAT_R32_SFLOAT);
  const GraphicsProgram program(device(), {.name = "min",
                                           .vertex = vertex_,
                                           .fragment = GNOMON_TEST_SHADER("draw_depth.frag.glsl"),
                                           .colorFormats = {VK_FORMAT_R32_SFLOAT},
                                           .minBlend = true});
  Positions values;
  for (const float z : {0.5f, 0.25f, 0.75f})  // neither first nor last is nearest
    for (const glm::vec4& position : halfTriangle(z)) values.push_back(position);
  const Buffer buffer = positions(values);
  render({.colors = {{&color, VkClearColorValue{{1.0f, 1.0f, 1.0f, 1.0f}}}}}, [&](Commands& commands) {
    commands.bind(program, {}, {{0, buffer}});
    commands.draw(9, 1, 0, 0);
  });
  const auto depths = downloadAs<float>(device(), color);
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(depths[y * kSize + x], inHalf(x, y) ? 0.25f : 1.0f);
}

TEST_F(RasterTest, ThePrimitiveNumberReachesTheFragmentShaderOfAnIndexedDraw) {
  const Image color = colorImage(VK_FORMAT_R32_UINT);
  const GraphicsProgram program(device(), {.name = "numbers",
                                           .vertex = vertex_,
                                           .fragment = GNOMON_TEST_SHADER("draw_primitive_number.frag.glsl"),
                                           .colorFormats = {VK_FORMAT_R32_UINT}});
  // Two halves of a square, the second first in the index buffer.
  const Buffer buffer = positions({{-1, -1, 0, 1}, {1, -1, 0, 1}, {-1, 1, 0, 1}, {1, 1, 0, 1}});
  const Buffer indices = createBufferWith(device(), "indices", std::vector<uint32_t>{9, 9, 9, 2, 1, 3, 0, 1, 2},
                                          VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  render({.colors = {{&color, VkClearColorValue{}}}}, [&](Commands& commands) {
    commands.bind(program, {}, {{0, buffer}});
    commands.bindIndexBuffer(indices);
    commands.drawIndexed(6, 1, 3, 0, 0);
  });
  const auto numbers = downloadAs<uint32_t>(device(), color);
  EXPECT_EQ(numbers[0], 2u);                  // upper left
  EXPECT_EQ(numbers[kSize * kSize - 1], 1u);  // lower right
  for (const uint32_t number : numbers) EXPECT_TRUE(number == 1u || number == 2u) << number;
}

TEST_F(RasterTest, CullingDropsTheSideThatIsAsked) {
  const GraphicsProgram program(device(), {.name = "culled", .vertex = vertex_, .depthFormat = VK_FORMAT_D32_SFLOAT});
  const Buffer buffer = positions(halfTriangle(0.5f));  // clockwise, as seen with y down
  const auto drawn = [&](VkCullModeFlags mode, VkFrontFace front) {
    const Image depth = depthImage();
    render({.depth = &depth, .clearDepth = 1.0f}, [&](Commands& commands) {
      commands.setCulling(mode, front);
      commands.bind(program, {}, {{0, buffer}});
      commands.draw(3, 1, 0, 0);
    });
    return downloadAs<float>(device(), depth)[0] == 0.5f;
  };
  EXPECT_TRUE(drawn(VK_CULL_MODE_NONE, VK_FRONT_FACE_CLOCKWISE));
  EXPECT_TRUE(drawn(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_CLOCKWISE));
  EXPECT_FALSE(drawn(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE));
  EXPECT_FALSE(drawn(VK_CULL_MODE_FRONT_BIT, VK_FRONT_FACE_CLOCKWISE));
}

TEST_F(RasterTest, DepthClampKeepsWhatIsInFrontOfTheNearPlane) {
  const Buffer buffer = positions(halfTriangle(-0.5f));
  for (const bool clamp : {false, true}) {
    const GraphicsProgram program(
        device(), {.name = "clamped", .vertex = vertex_, .depthFormat = VK_FORMAT_D32_SFLOAT, .depthClamp = clamp});
    const Image depth = depthImage();
    render({.depth = &depth, .clearDepth = 1.0f}, [&](Commands& commands) {
      commands.bind(program, {}, {{0, buffer}});
      commands.draw(3, 1, 0, 0);
    });
    EXPECT_EQ(downloadAs<float>(device(), depth)[0], clamp ? 0.0f : 1.0f);
  }
}

TEST_F(RasterTest, TargetsOfDifferentSizesAbort) {
  const Image color = colorImage(VK_FORMAT_R32_SFLOAT);
  const Image depth(device(), {.name = "smaller",
                               .format = VK_FORMAT_D32_SFLOAT,
                               .width = 8,
                               .height = 16,
                               .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
  Commands commands(device(), "wrong");
  EXPECT_DEATH(commands.beginRendering({.colors = {{&color, {}}}, .depth = &depth}), "16 against 8");
}

}  // namespace
}  // namespace gnomon::gpu
