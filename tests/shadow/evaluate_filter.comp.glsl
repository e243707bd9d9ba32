// answerFilter for every query.
#include "tests/kernel.glsl"
#include "tests/filter_functions.glsl"
GNOMON_KERNEL(FilterQuery, FilterAnswer, answerFilter)
