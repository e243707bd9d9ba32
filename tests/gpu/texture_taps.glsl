// What texture_test.cpp evaluates on both sides.
#ifndef GNOMON_TEST_TEXTURE_TAPS_GLSL
#define GNOMON_TEST_TEXTURE_TAPS_GLSL

#include "shared/texture.glsl"

GNOMON_SHARED_BEGIN

struct TextureLookup {
  TextureInfo info;
  vec2 uv;
};

GNOMON_FN TextureTaps lookUp(TextureLookup lookup) { return textureTaps(lookup.info, lookup.uv); }

GNOMON_SHARED_END
#endif
