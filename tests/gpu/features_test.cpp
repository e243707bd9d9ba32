// The list of required features: a device that lacks one is refused by that feature's name.
#include "gpu/features.h"

#include <gtest/gtest.h>

namespace gnomon::gpu {
namespace {

Capabilities sufficient() {
  Capabilities capabilities;
  capabilities.apiVersion = VK_API_VERSION_1_3;
  capabilities.extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  capabilities.features = enabledFeatures(capabilities);  // every required feature is on
  return capabilities;
}

TEST(Features, WhatIsEnabledIsSufficient) {
  EXPECT_TRUE(missingRequirements(sufficient()).empty());
}

TEST(Features, OneMissingFeatureIsNamed) {
  Capabilities capabilities = sufficient();
  capabilities.features.v12.scalarBlockLayout = VK_FALSE;
  const std::vector<std::string> missing = missingRequirements(capabilities);
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_TRUE(missing[0].starts_with("scalarBlockLayout")) << missing[0];
}

TEST(Features, AMissingExtensionIsNamed) {
  Capabilities capabilities = sufficient();
  capabilities.extensions.clear();
  EXPECT_EQ(missingRequirements(capabilities), std::vector<std::string>{"VK_KHR_push_descriptor"});
}

TEST(Features, AnOldDeviceIsToldItsVersion) {
  Capabilities capabilities = sufficient();
  capabilities.apiVersion = VK_API_VERSION_1_1;
  const std::vector<std::string> missing = missingRequirements(capabilities);
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0], "Vulkan 1.3 (it has 1.1)");
}

TEST(Features, OptionalOnesAreEnabledOnlyWhereTheyExist) {
  Capabilities capabilities = sufficient();
  EXPECT_EQ(enabledFeatures(capabilities).core.features.tessellationShader, VK_FALSE);
  capabilities.features.core.features.tessellationShader = VK_TRUE;
  EXPECT_EQ(enabledFeatures(capabilities).core.features.tessellationShader, VK_TRUE);
  EXPECT_EQ(enabledExtensions(capabilities).size(), 1u);
}

TEST(Features, WhatACallerDoesNotSwitchOnIsNamed) {
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  EXPECT_GT(notEnabled(info).size(), 10u);
  const Capabilities capabilities = sufficient();
  Features features = enabledFeatures(capabilities);
  features.chain(false);
  const std::vector<const char*> extensions = enabledExtensions(capabilities);
  info.pNext = &features.core;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  EXPECT_EQ(notEnabled(info), std::vector<std::string>());
  EXPECT_FALSE(enablesOrderedAccess(info));
  features.v13.synchronization2 = VK_FALSE;
  ASSERT_EQ(notEnabled(info).size(), 1u);
  EXPECT_TRUE(notEnabled(info)[0].starts_with("synchronization2"));
  // In a struct of the extension that became part of 1.3, and core features without the struct around them.
  VkPhysicalDeviceSynchronization2Features own{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
  own.synchronization2 = VK_TRUE;
  features.v13.dynamicRendering = features.v13.maintenance4 = VK_FALSE;
  features.v12.pNext = &own;
  EXPECT_EQ(notEnabled(info).size(), 2u);
  const VkPhysicalDeviceFeatures core = features.core.features;
  info.pNext = &features.v11;
  EXPECT_GT(notEnabled(info).size(), 5u);
  info.pEnabledFeatures = &core;
  EXPECT_EQ(notEnabled(info).size(), 2u);
}

}  // namespace
}  // namespace gnomon::gpu
