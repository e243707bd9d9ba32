// What a shader's SPIR-V declares, read through SPIRV-Cross.
#include "base/check.h"
#include "base/error.h"
#include "gpu/program.h"

#include <memory>

#include <fmt/format.h>
#include <spirv_cross/spirv_cross_c.h>

namespace gnomon::gpu {

namespace {

struct ReflectedType {
  spvc_resource_type resources;
  VkDescriptorType descriptor;
};

const ReflectedType kTypes[] = {
    {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
    {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
    {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
    {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
    {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
    {SPVC_RESOURCE_TYPE_SUBPASS_INPUT, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT},
};

const spvc_resource_type kRefused[] = {
    SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS,
    SPVC_RESOURCE_TYPE_ATOMIC_COUNTER,
    SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE,
};

void check(spvc_context context, spvc_result result) {
  if (result == SPVC_SUCCESS) return;
  const std::string error = spvc_context_get_last_error_string(context);
  // It takes every exception for one about the SPIR-V.
  if (result == SPVC_ERROR_OUT_OF_MEMORY || error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  throw WorldError(fmt::format("a shader's SPIR-V cannot be read: {}; empty the cache folder", error));
}

struct ResourceList {
  const spvc_reflected_resource* items = nullptr;
  size_t count = 0;
};

ResourceList list(spvc_context context, spvc_resources resources, spvc_resource_type type) {
  ResourceList found;
  check(context, spvc_resources_get_resource_list_for_type(resources, type, &found.items, &found.count));
  return found;
}

ProgramInterface::Binding bindingOf(spvc_compiler compiler, const spvc_reflected_resource& resource,
                                    VkDescriptorType type, VkShaderStageFlagBits stage) {
  ProgramInterface::Binding binding;
  binding.index = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationBinding);
  binding.type = type;
  const spvc_type handle = spvc_compiler_get_type_handle(compiler, resource.type_id);
  if (type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE && spvc_type_get_image_dimension(handle) == SpvDimBuffer)
    binding.type = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
  binding.stages = stage;
  // A block is known by its instance name, or else by its block name.
  const char* instance = spvc_compiler_get_name(compiler, resource.id);
  binding.name = instance && *instance ? instance : resource.name;
  binding.repeats = type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER &&
                    spvc_type_get_image_dimension(handle) == SpvDim2D &&
                    spvc_type_get_image_arrayed(handle) == SPVC_FALSE;
  const uint32_t set = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationDescriptorSet);
  if (set != 0)
    throw WorldError(fmt::format("binding '{}' is in set {}; every binding must be in set 0", binding.name, set));
  if (spvc_type_get_num_array_dimensions(handle) != 0)
    throw WorldError(
        fmt::format("binding '{}' is an array of resources; use an array texture or one buffer", binding.name));
  return binding;
}

}  // namespace

ProgramInterface reflect(const std::vector<uint32_t>& spirv, VkShaderStageFlagBits stage) {
  spvc_context context = nullptr;
  GNOMON_CHECK(spvc_context_create(&context) == SPVC_SUCCESS);
  const std::unique_ptr<spvc_context_s, void (*)(spvc_context)> owner(context, spvc_context_destroy);
  spvc_parsed_ir ir = nullptr;
  spvc_compiler compiler = nullptr;
  spvc_resources resources = nullptr;
  check(context, spvc_context_parse_spirv(context, spirv.data(), spirv.size(), &ir));
  check(context,
        spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler));
  // What main reaches, and not what an included file declares: the layout then holds nothing that a call
  // would leave unwritten.
  spvc_set active = nullptr;
  check(context, spvc_compiler_get_active_interface_variables(compiler, &active));
  check(context, spvc_compiler_create_shader_resources_for_active_variables(compiler, &resources, active));

  ProgramInterface interface;
  for (const ReflectedType& type : kTypes) {
    const ResourceList found = list(context, resources, type.resources);
    for (size_t i = 0; i < found.count; ++i)
      interface.bindings.push_back(bindingOf(compiler, found.items[i], type.descriptor, stage));
  }
  for (const spvc_resource_type type : kRefused) {
    const ResourceList found = list(context, resources, type);
    if (found.count > 0)
      throw WorldError(fmt::format("'{}' has a type that Gnomon cannot bind; use buffers, images and textures",
                                   found.items[0].name));
  }
  const ResourceList push = list(context, resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT);
  if (push.count > 0) {
    size_t bytes = 0;
    check(context, spvc_compiler_get_declared_struct_size(
                       compiler, spvc_compiler_get_type_handle(compiler, push.items[0].base_type_id), &bytes));
    interface.pushConstantBytes = static_cast<uint32_t>(bytes);
    interface.pushConstantStages = stage;
  }
  return interface;
}

}  // namespace gnomon::gpu
