// What reflect() reads out of SPIR-V.
#include "base/error.h"
#include "gpu/program.h"
#include "tests/gpu_fixture.h"

namespace gnomon::gpu {
namespace {

ProgramInterface reflectCompute(const ShaderSource& source) {
  return reflect(compileShader(source), VK_SHADER_STAGE_COMPUTE_BIT);
}

ProgramInterface reflectText(const std::string& text) {
  return reflectCompute(inlineShader("t/x.comp.glsl", "layout(local_size_x = 1) in;\n" + text));
}

const ProgramInterface::Binding* find(const ProgramInterface& interface, uint32_t index) {
  for (const ProgramInterface::Binding& binding : interface.bindings)
    if (binding.index == index) return &binding;
  return nullptr;
}

TEST(Reflect, TellsTypesNamesAndPushConstants) {
  const ProgramInterface interface = reflectCompute(GNOMON_TEST_SHADER("add_texture.comp.glsl"));
  const struct {
    uint32_t index;
    VkDescriptorType type;
    const char* name;
  } expected[] = {
      {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, "source"}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, "Output"},
      {2, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, "plain"},   {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, "sampled"},
      {7, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, "stored"},
  };
  ASSERT_EQ(interface.bindings.size(), std::size(expected));
  for (const auto& binding : expected) {
    const ProgramInterface::Binding* found = find(interface, binding.index);
    ASSERT_NE(found, nullptr) << binding.name;
    EXPECT_EQ(found->type, binding.type) << binding.name;
    EXPECT_EQ(found->name, binding.name);
    EXPECT_EQ(found->stages, VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT});
  }
  EXPECT_EQ(interface.pushConstantBytes, 16u);
  EXPECT_EQ(interface.pushConstantStages, VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT});
}

TEST(Reflect, IntegerTexturesAndSamplersAreTextures) {
  const ProgramInterface interface = reflectText(
      "layout(binding = 0) uniform utexture2DArray a;\n"
      "layout(binding = 1) uniform usampler2DArray b;\n"
      "layout(binding = 2, scalar) buffer B { uvec4 v; };\n"
      "void main() { v = texelFetch(a, ivec3(0), 0) + texelFetch(b, ivec3(0), 0); }\n");
  ASSERT_EQ(interface.bindings.size(), 3u);
  EXPECT_EQ(find(interface, 0)->type, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  EXPECT_EQ(find(interface, 1)->type, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  EXPECT_EQ(interface.pushConstantBytes, 0u);
}

// So that an included file may declare more than a shader uses, and no descriptor stays unwritten (which
// crashes lavapipe 22.3).
TEST(Reflect, ABindingThatIsDeclaredAndNotUsedIsLeftOut) {
  const ProgramInterface interface = reflectText(
      "layout(binding = 0) uniform texture2DArray unused;\n"
      "layout(binding = 1, scalar) buffer B { uint v; };\n"
      "void main() { v = 1u; }\n");
  ASSERT_EQ(interface.bindings.size(), 1u);
  EXPECT_EQ(interface.bindings[0].index, 1u);
}

TEST(Reflect, PushConstantsAreMeasuredInScalarLayout) {
  const ProgramInterface interface = reflectText(
      "struct S { vec3 a; float b; vec3 c; };\n"
      "layout(push_constant, scalar) uniform P { mat4 m; S s; uint flags[3]; };\n"
      "layout(binding = 1, scalar) buffer B { vec3 v; };\n"
      "void main() { v = m[0].xyz + s.a + s.c + float(flags[2]); }\n");
  EXPECT_EQ(interface.pushConstantBytes, 64u + 28u + 12u);
}

TEST(Reflect, OtherSetsArraysAndKindsAreRefusedByName) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      reflectText(text);
    } catch (const WorldError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("layout(set = 1, binding = 0, scalar) buffer B { uint v; } far;\nvoid main() { far.v = 1u; }\n")
                .find("'far' is in set 1"),
            std::string::npos);
  EXPECT_NE(refusal("layout(binding = 0, scalar) buffer B { uint v; } many[3];\nvoid main() { many[1].v = 1u; }\n")
                .find("'many' is an array"),
            std::string::npos);
  EXPECT_NE(refusal("layout(binding = 0) uniform sampler alone;\nlayout(binding = 1) uniform texture2D t;\n"
                    "layout(binding = 2, scalar) buffer B { vec4 v; };\n"
                    "void main() { v = textureLod(sampler2D(t, alone), vec2(0), 0); }\n")
                .find("'alone' has a type that Gnomon cannot bind"),
            std::string::npos);
}

TEST(Reflect, WhatIsNoSpirvIsRefused) {
  EXPECT_THROW(reflect({0x07230203u, 1u, 2u}, VK_SHADER_STAGE_COMPUTE_BIT), WorldError);
  EXPECT_THROW(reflect({}, VK_SHADER_STAGE_COMPUTE_BIT), WorldError);
}

}  // namespace
}  // namespace gnomon::gpu
