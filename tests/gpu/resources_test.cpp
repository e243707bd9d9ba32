// Buffers and images: what goes in comes out, and what does not fit is refused by name.
#include "gpu/resources.h"
#include "base/error.h"
#include "base/sanitizers.h"
#include "tests/gpu_fixture.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <numeric>

#include <fmt/format.h>

namespace gnomon::gpu {
namespace {

template <typename Make>
std::string refusal(Make make) {
  try {
    make();
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::byte> pattern(size_t size) {
  std::vector<std::byte> bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>((i * 2654435761u) >> 13);
  return bytes;
}

// Empty, odd, whole words, and around the staging chunk of 16 MiB.
constexpr size_t kSizes[] = {0, 1, 3, 4, 5, 4096, (16u << 20) - 1, 16u << 20, (16u << 20) + 1, (33u << 20) + 7};

void checkRoundTrips(const Device& device, Memory memory) {
  for (const size_t size : kSizes) {
    const std::vector<std::byte> bytes = pattern(size);
    const Buffer buffer(device, {.name = "round trip", .size = size, .memory = memory});
    EXPECT_EQ(buffer.size(), size == 0 ? 4 : size);
    upload(device, buffer, bytes);
    std::vector<std::byte> back(size);
    download(device, buffer, back);
    EXPECT_TRUE(back == bytes) << size << " bytes";
    EXPECT_EQ(downloadAs<std::byte>(device, buffer).size(), buffer.size());
    EXPECT_EQ(downloadAs<std::byte>(device, buffer, 1).size(), 1u);
  }
}

class ResourcesTest : public GpuTest {};

// Device memory as a discrete GPU has it: everything goes through staging.
class StagedResourcesTest : public GpuTest {
 protected:
  StagedResourcesTest() : GpuTest({.hideDeviceMemory = true}) {}
};

TEST_F(ResourcesTest, BuffersOfAllSizesComeBack) {
  checkRoundTrips(device(), Memory::Device);
  checkRoundTrips(device(), Memory::Readback);
}

TEST_F(StagedResourcesTest, BuffersOfAllSizesComeBack) {
  EXPECT_EQ(Buffer(device(), {.name = "hidden", .size = 4}).mapped(), nullptr);
  checkRoundTrips(device(), Memory::Device);
}

TEST_F(ResourcesTest, AVectorMakesABufferAndABufferMakesAVector) {
  std::vector<uint32_t> values(1000);
  std::iota(values.begin(), values.end(), 5u);
  EXPECT_EQ(downloadAs<uint32_t>(device(), createBufferWith(device(), "values", values)), values);
  EXPECT_EQ(createBufferWith(device(), "empty", std::vector<uint32_t>{}).size(), 4u);
}

TEST_F(ResourcesTest, UploadPastTheEndAborts) {
  const Buffer buffer(device(), {.name = "small", .size = 4});
  EXPECT_DEATH(upload(device(), buffer, pattern(5)), "5 against 4");
}

TEST_F(ResourcesTest, AnImageArrayComesBackLayerAfterLayerFromTheTop) {
  const Image image(device(), {.name = "layers",
                               .format = VK_FORMAT_R32_SFLOAT,
                               .width = 5,
                               .height = 3,
                               .layerCount = 4,
                               .array = true,
                               .usage = VK_IMAGE_USAGE_STORAGE_BIT});
  const ComputeProgram program(device(), GNOMON_TEST_SHADER("write_texel_numbers.comp.glsl"));
  Commands commands(device(), "write");
  commands.dispatch(program, {5, 3, 4}, {}, {{0, image}});
  commands.submitAndWait();
  std::vector<float> expected(5 * 3 * 4);
  std::iota(expected.begin(), expected.end(), 0.0f);
  EXPECT_EQ(downloadAs<float>(device(), image), expected);
}

TEST_F(ResourcesTest, ABufferBeyondTheLimitIsRefusedWithBothSizes) {
  const uint64_t most = device().info().maxStorageBufferBytes;
  const std::string message = refusal([&] { Buffer(device(), {.name = "shadow volume", .size = most + 1}); });
  EXPECT_NE(message.find("'shadow volume' needs"), std::string::npos) << message;
  EXPECT_NE(message.find("MiB"), std::string::npos) << message;
  const std::string allocation = refusal([&] {
    Buffer(device(), {.name = "vast", .size = uint64_t{1} << 50, .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT});
  });
  EXPECT_NE(allocation.find("largest allocation"), std::string::npos) << allocation;
}

TEST_F(ResourcesTest, AnImageBeyondTheLimitsIsRefusedByName) {
  const uint32_t most = device().info().maxImageDimension2D;
  const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
  const std::string wide = refusal([&] {
    Image(device(), {.name = "wide map", .format = VK_FORMAT_R32_SFLOAT, .width = most + 1, .usage = sampled});
  });
  EXPECT_NE(wide.find("'wide map'"), std::string::npos) << wide;
  EXPECT_NE(wide.find(fmt::format("{}", most)), std::string::npos) << wide;
  const std::string deep = refusal([&] {
    Image(device(), {.name = "deep map",
                     .format = VK_FORMAT_R32_SFLOAT,
                     .layerCount = device().info().maxImageLayers + 1,
                     .array = true,
                     .usage = sampled});
  });
  EXPECT_NE(deep.find("layers"), std::string::npos) << deep;
  // 16 GiB and more: within the largest width, beyond any single image or allocation of a CPU device.
  if (!isLavapipe()) GTEST_SKIP() << "how much fits is the device's own";
  const std::string heavy = refusal([&] {
    Image(device(), {.name = "heavy map",
                     .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                     .width = most,
                     .height = most,
                     .layerCount = 8,
                     .array = true,
                     .usage = sampled});
  });
  EXPECT_NE(heavy.find("'heavy map' needs 32768.0 MiB"), std::string::npos) << heavy;
}

// The driver itself runs out: the address space is capped a little above what is in use.
TEST_F(ResourcesTest, MemoryThatRunsOutIsReportedByNameAndTheNextSmallerOneFits) {
  if (kHasSanitizers) GTEST_SKIP() << "skipped: sanitizers take terabytes of addresses";
  if (!isLavapipe()) GTEST_SKIP() << "the cap below is on the CPU's memory";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
  rlimit capped = before;
  std::ifstream statm("/proc/self/statm");
  size_t pages = 0;
  statm >> pages;
  capped.rlim_cur = pages * static_cast<size_t>(::sysconf(_SC_PAGESIZE)) + (200u << 20);
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &capped), 0);
  const BufferDesc large{.name = "index list", .size = 1u << 30, .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT};
  const std::string message = refusal([&] { Buffer(device(), large); });
  EXPECT_TRUE(message.starts_with("'index list' needs 1024.0 MiB of memory, which")) << message;
  EXPECT_EQ(Buffer(device(), {.name = "small", .size = 1u << 20}).size(), 1u << 20);
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_EQ(device().takeValidationMessages(), std::vector<std::string>{"VK_ERROR_OUT_OF_DEVICE_MEMORY"});
}

TEST_F(ResourcesTest, AFormatTheDeviceLacksIsRefused) {
  const std::string message = refusal([&] {
    Image(device(), {.name = "odd", .format = VK_FORMAT_D32_SFLOAT, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  });
  EXPECT_NE(message.find("'odd'"), std::string::npos) << message;
}

TEST_F(ResourcesTest, ResourcesMove) {
  Buffer a = createBufferWith(device(), "a", std::vector<uint32_t>{1, 2, 3});
  Buffer b = std::move(a);
  EXPECT_EQ(downloadAs<uint32_t>(device(), b), (std::vector<uint32_t>{1, 2, 3}));
  b = createBufferWith(device(), "b", std::vector<uint32_t>{4});
  EXPECT_EQ(downloadAs<uint32_t>(device(), b), std::vector<uint32_t>{4});
}

}  // namespace
}  // namespace gnomon::gpu
