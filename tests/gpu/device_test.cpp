// Creating devices: the choice, its refusals, and that validation hears what it must.
#include "base/error.h"
#include "tests/gpu_fixture.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace gnomon::gpu {
namespace {

bool anyContains(const std::vector<std::string>& messages, const std::string& part) {
  for (const std::string& message : messages)
    if (message.find(part) != std::string::npos) return true;
  return false;
}

std::string refusal(const DeviceOptions& options) {
  try {
    Device::create(options);
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

class DeviceTest : public GpuTest {};

TEST_F(DeviceTest, DescribesItself) {
  const DeviceInfo& info = device().info();
  EXPECT_FALSE(info.name.empty());
  EXPECT_FALSE(info.driver.empty());
  EXPECT_TRUE(info.apiVersion.starts_with("1.")) << info.apiVersion;
  EXPECT_GE(info.maxImageDimension2D, 4096u);
  EXPECT_GE(info.maxStorageBufferBytes, 1u << 27);
  EXPECT_GE(info.maxAllocationBytes, 1u << 30);
  EXPECT_GT(info.timestampPeriod, 0.0f);
}

TEST_F(DeviceTest, IsListedAndIsFoundByPartOfItsNameInAnyCase) {
  bool listed = false;
  for (const DeviceInfo& info : listDevices()) listed |= info.name == device().info().name;
  EXPECT_TRUE(listed);
  std::string part = device().info().name.substr(0, 6);
  for (char& c : part) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(Device::create({.name = part})->info().name, device().info().name);
}

TEST_F(DeviceTest, AnUnknownNameIsRefusedWithTheNamesThereAre) {
  const std::string message = refusal({.name = "no such device"});
  EXPECT_NE(message.find("'no such device'"), std::string::npos) << message;
  EXPECT_NE(message.find(device().info().name), std::string::npos) << message;
}

TEST_F(DeviceTest, TheEnvironmentNamesTheDeviceUnlessTheOptionsDo) {
  ::setenv("GNOMON_DEVICE", "no such device", 1);
  EXPECT_NE(refusal({}).find("no such device"), std::string::npos);
  EXPECT_EQ(refusal({.name = device().info().name}), "");
  ::unsetenv("GNOMON_DEVICE");
}

TEST(Device, AMissingValidationLayerIsNamedWithItsPackage) {
  const TemporaryFolder nothing;
  ::setenv("VK_LAYER_PATH", nothing.path().c_str(), 1);
  const std::string message = refusal({.validation = true});
  ::unsetenv("VK_LAYER_PATH");
  EXPECT_NE(message.find("apt-get install vulkan-validationlayers"), std::string::npos) << message;
}

TEST(Device, WithoutADriverTheRemedyIsAPackage) {
  const TemporaryFolder nothing;
  std::ofstream(nothing.path() / "none.json") << "{}";
  ::setenv("VK_ICD_FILENAMES", (nothing.path() / "none.json").c_str(), 1);
  const std::string message = refusal({});
  EXPECT_TRUE(listDevices().empty());
  ::unsetenv("VK_ICD_FILENAMES");
  EXPECT_NE(message.find("apt-get install mesa-vulkan-drivers"), std::string::npos) << message;
}

TEST_F(DeviceTest, ValidationHearsAWrongCall) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = 4;
  info.usage = 0;  // must not be 0
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(device().handle(), &info, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(device().handle(), buffer, nullptr);
  EXPECT_FALSE(device().validationMessages().empty());
  EXPECT_TRUE(anyContains(device().takeValidationMessages(), "VUID-VkBufferCreateInfo-usage"));
  EXPECT_TRUE(device().validationMessages().empty());
}

TEST_F(DeviceTest, SynchronizationValidationHearsAMissingBarrier) {
  const Buffer a(device(), {.name = "a", .size = 64});
  const Buffer b(device(), {.name = "b", .size = 64});
  Commands commands(device(), "hazard");
  commands.fill(a, 1);
  commands.copy(a, b, 64);  // reads what nobody made visible
  commands.submitAndWait();
  EXPECT_TRUE(anyContains(device().takeValidationMessages(), "SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST(Device, TheEnvironmentTurnsValidationOn) {
  ::setenv("GNOMON_VALIDATION", "1", 1);
  std::vector<std::string> messages;
  const auto device = Device::create({.messageSink = &messages});
  ::unsetenv("GNOMON_VALIDATION");
  const Buffer a(*device, {.name = "a", .size = 64});
  const Buffer b(*device, {.name = "b", .size = 64});
  Commands commands(*device, "hazard");
  commands.fill(a, 1);
  commands.copy(a, b, 64);
  commands.submitAndWait();
  EXPECT_TRUE(anyContains(messages, "SYNC-HAZARD"));
}

TEST(Device, AnObjectLeftAliveIsReportedWhenTheDeviceGoes) {
  std::vector<std::string> messages;
  auto device = Device::create({.validation = true, .messageSink = &messages});
  VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateFence(device->handle(), &info, nullptr, &fence), VK_SUCCESS);
  EXPECT_TRUE(messages.empty());
  device.reset();
  EXPECT_TRUE(anyContains(messages, "VUID-vkDestroyDevice-device")) << messages.size();
}

// What the loader looks up for a name must not be freed meanwhile. What is freed is overwritten, so that it is seen.
TEST(Device, ObjectsAreNamedWhileOtherDevicesComeAndGo) {
  ::mallopt(M_PERTURB, 0xaa);
  const auto device = Device::create({.validation = true});
  std::atomic<bool> done = false;
  std::thread others([&] {
    for (int i = 0; i < 20; ++i) Device::create({});
    done = true;
  });
  while (!done) const Buffer named(*device, {.name = "named", .size = 64});
  others.join();
  ::mallopt(M_PERTURB, 0);
  EXPECT_TRUE(device->takeValidationMessages().empty());
}

TEST(Device, ThePipelineCacheIsKeptAndATornOneIsPassedOver) {
  const TemporaryFolder cache;
  ::setenv("GNOMON_CACHE_DIR", cache.path().c_str(), 1);
  std::vector<std::string> messages;
  const DeviceOptions options{.validation = true, .messageSink = &messages};
  Device::create(options);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(cache.path())) files.push_back(entry.path());
  ASSERT_EQ(files.size(), 1u);
  const std::string whole = readFile(files[0]);
  EXPECT_GE(whole.size(), 32u);
  writeTextFile(files[0], "torn");
  Device::create(options);
  EXPECT_EQ(readFile(files[0]), whole);
  ::setenv("GNOMON_CACHE_DIR", "/dev/null/nowhere", 1);
  Device::create(options);
  EXPECT_TRUE(messages.empty());
}

}  // namespace
}  // namespace gnomon::gpu
