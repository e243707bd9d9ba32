// sin, cos, atan, acos, exp, log and pow for every input.
#include "tests/arithmetic.glsl"
#include "tests/kernel.glsl"
GNOMON_KERNEL(TranscendentalInput, TranscendentalOutput, computeTranscendentals)
