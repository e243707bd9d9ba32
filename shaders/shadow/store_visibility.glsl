// Where a pixel's visibility goes: a buffer, unless the pass writes a renderer's own image
// (VisibilityPass::storeInImage), which takes this file's place.
#ifndef GNOMON_STORE_VISIBILITY_GLSL
#define GNOMON_STORE_VISIBILITY_GLSL

#include "shared/shade.glsl"

layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };

void storeVisibility(ivec2 pixel, int width, float value) { visibility[uint(pixel.y * width + pixel.x)] = value; }

#endif
