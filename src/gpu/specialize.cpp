#include "gpu/specialize.h"

#include "base/check.h"
#include "gpu/spirv_cache.h"

#include <string>
#include <unordered_map>

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>

namespace gnomon::gpu {

namespace {

// One more wherever the passes below change.
constexpr int kPassesVersion = 2;

Hash128 keyOf(const std::vector<uint32_t>& spirv, const std::vector<Specialization>& specializations) {
  std::string text = fmt::format("specialized {}", kPassesVersion);
  for (const Specialization& constant : specializations) text += fmt::format(" {}={}", constant.id, constant.value);
  text.append(reinterpret_cast<const char*>(spirv.data()), spirv.size() * sizeof(uint32_t));
  return hashText(text);
}

}  // namespace

std::vector<uint32_t> specialize(const std::vector<uint32_t>& spirv,
                                 const std::vector<Specialization>& specializations) {
  const Hash128 key = keyOf(spirv, specializations);
  if (std::optional<std::vector<uint32_t>> cached = readCachedSpirv(key)) return std::move(*cached);

  std::unordered_map<uint32_t, std::vector<uint32_t>> values;
  for (const Specialization& constant : specializations) values[constant.id] = {static_cast<uint32_t>(constant.value)};
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreateRemoveUnusedInterfaceVariablesPass());
  std::vector<uint32_t> specialized;
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // glslang wrote it; and it knows nothing of the device's scalar layout
  GNOMON_CHECK(optimizer.Run(spirv.data(), spirv.size(), &specialized, options));
  writeCachedSpirv(key, specialized);
  return specialized;
}

}  // namespace gnomon::gpu
