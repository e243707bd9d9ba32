// Where light that is scattered towards the eye goes: a buffer, unless the pass writes a renderer's own image
// (MediaPass::record), which takes this file's place.
#ifndef GNOMON_STORE_SCATTERED_GLSL
#define GNOMON_STORE_SCATTERED_GLSL

#include "shared/media_pass.glsl"

layout(scalar, binding = kBindInScattered) buffer InScattered { vec3 inScattered[]; };

vec3 scatteredBefore(ivec2 pixel, int width) { return inScattered[uint(pixel.y * width + pixel.x)]; }
void storeScattered(ivec2 pixel, int width, vec3 light) { inScattered[uint(pixel.y * width + pixel.x)] = light; }

#endif
