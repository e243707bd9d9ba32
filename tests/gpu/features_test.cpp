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

}  // namespace
}  // namespace gnomon::gpu
