// mediumAnswer for every query.
#include "tests/kernel.glsl"
#include "tests/medium_functions.glsl"
GNOMON_KERNEL(MediumQuery, MediumAnswer, mediumAnswer)
