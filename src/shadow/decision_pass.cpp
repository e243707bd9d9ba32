#include "shadow/decision_pass.h"

#include "base/check.h"
#include "shadow/user_bias.h"

#include "shared/bias.glsl"

#include <algorithm>

namespace gnomon {

namespace {

constexpr const char* kDecisionShader = "shadow/decide_methods.comp.glsl";
constexpr size_t kFlagsOfAWord = 4;  // methods
constexpr uint32_t kFirstMethodConstant = 14;

size_t flagPlanes(size_t methods) {
  return (methods + kFlagsOfAWord - 1) / kFlagsOfAWord;
}

const UserBias* userOf(std::span<const BiasMethod* const> biases) {
  const auto found = std::ranges::find_if(biases, [](const BiasMethod* bias) { return bias->user != nullptr; });
  return found == biases.end() ? nullptr : (*found)->user;
}

}  // namespace

bool decidedTogether(const BiasMethod& a, const BiasMethod& b) {
  const bool oneUser = a.user == nullptr || b.user == nullptr || a.user == b.user;
  return a.channels == b.channels && oneUser && !a.knowsSurfaces() && !b.knowsSurfaces();
}

Decisions::Decisions(std::vector<const BiasMethod*> biases, std::vector<uint32_t> planes)
    : biases_(std::move(biases)), planes_(std::move(planes)), pixelCount_(planes_.size() / planeCount(biases_)) {}

size_t Decisions::planeCount(std::span<const BiasMethod* const> biases) {
  const auto moving = std::ranges::count_if(biases, [](const BiasMethod* b) { return glsl::biasMovesReceiver(b->id); });
  return flagPlanes(biases.size()) + 1 + static_cast<size_t>(moving);
}

std::vector<glsl::PixelDiagnosis> Decisions::of(size_t method) const {
  GNOMON_CHECK_LT(method, biases_.size());
  const std::span before = std::span(biases_).first(method);
  const bool moves = glsl::biasMovesReceiver(biases_[method]->id);
  const size_t texelPlane = moves ? planeCount(before) - flagPlanes(before.size()) : 0;
  const uint32_t* texels = planes_.data() + (flagPlanes(biases_.size()) + texelPlane) * pixelCount_;
  const uint32_t* flags = planes_.data() + method / kFlagsOfAWord * pixelCount_;
  const uint32_t shift = 8 * (method % kFlagsOfAWord);
  std::vector<glsl::PixelDiagnosis> pixels(pixelCount_);
  for (size_t i = 0; i < pixelCount_; ++i) {
    pixels[i].flags = flags[i] >> shift & 255u;
    if ((pixels[i].flags & glsl::kPixelCovered) != 0) pixels[i].texel = texels[i];
  }
  return pixels;
}

DecisionPass::DecisionPass(const gpu::Device& device, int width, int height)
    : device_(device),
      pixelCount_(static_cast<size_t>(width) * static_cast<size_t>(height)),
      groupCount_(shadeGroups(width, height)),
      uniforms_(device, {.name = "decision uniforms",
                         .size = sizeof(glsl::ShadeUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      params_(device, {.name = "parameters of methods",
                       .size = glsl::kMostTogether * sizeof(glsl::BiasParams),
                       .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      noIds_(createNoIds(device)) {}

size_t DecisionPass::mostOf(std::span<const BiasMethod* const> biases) const {
  size_t count = 1;
  while (count < std::min<size_t>(biases.size(), glsl::kMostTogether) && decidedTogether(*biases[0], *biases[count]) &&
         Decisions::planeCount(biases.first(count + 1)) * pixelCount_ * sizeof(uint32_t) <=
             device_.info().maxStorageBufferBytes)
    ++count;
  return count;
}

gpu::ComputeProgram DecisionPass::makeProgram(const VariantKey& key) const {
  std::vector<gpu::Specialization> constants = {{.id = 2, .value = key.mapKind},
                                                {.id = 3, .value = key.sliceCount},
                                                {.id = 4, .value = key.instanced},
                                                {.id = 5, .value = key.channels},
                                                {.id = 13, .value = static_cast<int32_t>(key.methods.size())}};
  for (size_t i = 0; i < key.methods.size(); ++i)
    constants.push_back({.id = kFirstMethodConstant + static_cast<uint32_t>(i), .value = key.methods[i]});
  return createLookupProgram(device_, shaderWith(kDecisionShader, key.user.bias), key.user.bias, constants);
}

void DecisionPass::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                          const MapImage& map, std::span<const BiasMethod* const> biases,
                          std::span<const glsl::BiasParams> params, const glsl::ShadeUniforms& shade) {
  GNOMON_CHECK_EQ(biases.size(), params.size());
  GNOMON_CHECK_EQ(mostOf(biases), biases.size());
  const ChannelSet read = biases.front()->channels;
  GNOMON_CHECK_EQ(read & ~map.channels(), 0);
  VariantKey key{.mapKind = map.kind(),
                 .sliceCount = map.sliceCount(),
                 .instanced = scene.instanced ? 1 : 0,
                 .channels = read,
                 .methods = {},
                 .user = userOf(biases)};
  for (const BiasMethod* bias : biases) key.methods.push_back(bias->id);
  const gpu::ComputeProgram& program = variants_.get(key, [&](const VariantKey& k) { return makeProgram(k); });
  const VkDeviceSize bytes = Decisions::planeCount(biases) * pixelCount_ * sizeof(uint32_t);
  if (planes_.size() < bytes) planes_ = gpu::Buffer(device_, {.name = "decisions", .size = bytes});
  std::vector<glsl::BiasParams> all(params.begin(), params.end());
  all.resize(glsl::kMostTogether);
  gpu::upload(device_, params_, std::as_bytes(std::span(all)));
  gpu::upload(device_, uniforms_, gpu::asPush(shade));
  std::vector<gpu::Binding> bindings = lookupBindings(scene, gbuffer, uniforms_, map, noIds_);
  bindings.insert(bindings.end(),
                  {{glsl::kBindShade, uniforms_}, {glsl::kBindMethodParams, params_}, {glsl::kBindDecisions, planes_}});
  commands.dispatch(program, groupCount_, {}, bindings);
}

Decisions DecisionPass::download(std::span<const BiasMethod* const> biases) const {
  const size_t words = Decisions::planeCount(biases) * pixelCount_;
  return {{biases.begin(), biases.end()}, gpu::downloadAs<uint32_t>(device_, planes_, words)};
}

}  // namespace gnomon
