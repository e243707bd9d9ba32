#pragma once
// GPU equals CPU: one shared function, evaluated by a compute shader for every input, to be compared with the
// same function called here. The shader is three includes and one line, see kernel.glsl.

#include "base/check.h"
#include "tests/gpu_fixture.h"

#include <type_traits>
#include <vector>

namespace gnomon::gpu {

// STYLE 22: a claim about arithmetic is tested on at least this many inputs.
constexpr size_t kKernelInputCount = size_t{1} << 16;

// One Out per In, in order. Both must be the structs that the shader names, in scalar layout.
// `more`: buffers that the shader's includes declare, such as a map.
template <typename In, typename Out>
std::vector<Out> runKernel(const Device& device, const ShaderSource& shader, const std::vector<In>& inputs,
                           const std::vector<Binding>& more = {},
                           const std::vector<Specialization>& specializations = {}) {
  static_assert(std::is_trivially_copyable_v<In> && std::is_trivially_copyable_v<Out>);
  constexpr uint32_t kGroupSize = 64;  // as in kernel.glsl
  const auto count = static_cast<uint32_t>(inputs.size());
  const uint32_t groupCount = (count + kGroupSize - 1) / kGroupSize;
  GNOMON_CHECK_LE(groupCount, 65535u);  // what every device can dispatch
  const ComputeProgram program(device, shader, specializations);
  const Buffer inBuffer = createBufferWith(device, "kernel inputs", inputs);
  const Buffer outBuffer(device, {.name = "kernel outputs", .size = count * sizeof(Out)});
  Commands commands(device, "kernel");
  std::vector<Binding> bindings = {{0, inBuffer}, {1, outBuffer}};
  bindings.insert(bindings.end(), more.begin(), more.end());
  commands.dispatch(program, {groupCount, 1, 1}, asPush(count), bindings);
  commands.submitAndWait();
  return downloadAs<Out>(device, outBuffer);
}

}  // namespace gnomon::gpu
