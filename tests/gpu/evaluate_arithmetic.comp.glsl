// Basic arithmetic for every input.
#include "tests/arithmetic.glsl"
#include "tests/kernel.glsl"
GNOMON_KERNEL(ArithmeticInput, ArithmeticOutput, computeArithmetic)
