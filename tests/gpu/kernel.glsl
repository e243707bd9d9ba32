// The other half of run_kernel.h: GNOMON_KERNEL(In, Out, function) makes an entry point that writes
// function(inputs[i]) to outputs[i].
#define GNOMON_KERNEL(In, Out, function)                                       \
  layout(local_size_x = 64) in;                                                \
  layout(scalar, binding = 0) readonly buffer Inputs { In inputs[]; };         \
  layout(scalar, binding = 1) writeonly buffer Outputs { Out outputs[]; };     \
  layout(scalar, push_constant) uniform Push { uint inputCount; };             \
  void main() {                                                                \
    uint i = gl_GlobalInvocationID.x;                                          \
    if (i < inputCount) outputs[i] = function(inputs[i]);                      \
  }
