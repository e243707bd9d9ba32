// textureTaps for every look-up.
#include "tests/kernel.glsl"
#include "tests/texture_taps.glsl"
GNOMON_KERNEL(TextureLookup, TextureTaps, lookUp)
