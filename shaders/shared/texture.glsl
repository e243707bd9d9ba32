// Texture look-up by hand, so that an alpha mask has the same holes in the shaders and on the CPU.
//
// All textures of a scene lie one after another in one array of RGBA8 words (R in the low byte). A shader
// or a C++ function asks here which texels a uv touches and with what weights, and fetches them itself.
// uv follows glTF: (0,0) is the upper left corner of the first texel of the image.
#ifndef GNOMON_TEXTURE_GLSL
#define GNOMON_TEXTURE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kWrapRepeat = 0;
const int kWrapClamp = 1;
const int kWrapMirror = 2;
const int kTexFilterNearest = 0;
const int kTexFilterLinear = 1;

struct TextureInfo {
  uint firstTexel;  // index into the array of RGBA8 words
  int width;        // texels
  int height;       // texels
  int wrapS;        // kWrap*
  int wrapT;        // kWrap*
  int filterMode;   // kTexFilter*
};

// The four texels a look-up blends (the same one four times where the filter is nearest).
struct TextureTaps {
  uint texel[4];    // indices into the array of words: (0,0) (1,0) (0,1) (1,1)
  float weight[4];  // sums to 1
};

GNOMON_FN int wrapTexel(int i, int size, int wrap) {
  if (wrap == kWrapClamp) return clamp(i, 0, size - 1);
  int period = wrap == kWrapMirror ? 2 * size : size;
  int j = i - period * int(floor(float(i) / float(period)));
  j = clamp(j, 0, period - 1);
  return j < size ? j : period - 1 - j;
}

// The uv is reduced to one period first, so that a far-away uv cannot overflow an integer.
GNOMON_FN float wrapCoordinate(float u, int wrap) {
  if (wrap == kWrapClamp) return clamp(u, 0.0f, 1.0f);
  return u - 2.0f * floor(u * 0.5f);
}

GNOMON_FN TextureTaps textureTaps(TextureInfo info, vec2 uv) {
  float x = wrapCoordinate(uv.x, info.wrapS) * float(info.width);
  float y = wrapCoordinate(uv.y, info.wrapT) * float(info.height);
  TextureTaps taps;
  vec2 f = vec2(0.0f, 0.0f);
  int x0 = int(floor(x));
  int y0 = int(floor(y));
  int step = 0;
  if (info.filterMode == kTexFilterLinear) {
    x0 = int(floor(x - 0.5f));
    y0 = int(floor(y - 0.5f));
    f = vec2(x - 0.5f - float(x0), y - 0.5f - float(y0));
    step = 1;
  }
  for (int i = 0; i < 4; ++i) {
    int dx = i & 1;
    int dy = i >> 1;
    int tx = wrapTexel(x0 + dx * step, info.width, info.wrapS);
    int ty = wrapTexel(y0 + dy * step, info.height, info.wrapT);
    taps.texel[i] = info.firstTexel + uint(ty * info.width + tx);
    taps.weight[i] = (dx == 1 ? f.x : 1.0f - f.x) * (dy == 1 ? f.y : 1.0f - f.y);
  }
  return taps;
}

GNOMON_FN vec4 unpackRgba8(uint word) {
  return vec4(float(word & 255u), float((word >> 8u) & 255u), float((word >> 16u) & 255u), float(word >> 24u)) *
         (1.0f / 255.0f);
}

GNOMON_SHARED_END
#endif
