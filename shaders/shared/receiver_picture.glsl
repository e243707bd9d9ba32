// What a renderer's own depth buffer and normals mean, for shaders that take receivers from them
// (src/scene/receiver_picture.h).
#ifndef GNOMON_RECEIVER_PICTURE_GLSL
#define GNOMON_RECEIVER_PICTURE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindReceiverDepth = 35;
const int kBindReceiverNormals = 36;
const int kBindReceiverPicture = 37;  // ReceiverPicture

// How the texture of normals holds those of the world, unit or not.
const int kReceiverNormalsNone = 0;         // there is none
const int kReceiverNormalsSigned = 1;       // xyz, as they are
const int kReceiverNormalsUnorm = 2;        // xyz, as 0.5 n + 0.5
const int kReceiverNormalsOctahedral = 3;   // xy in [-1, 1]^2 (Cigolle et al., "A Survey of Efficient Representations
                                            // for Independent Unit Vectors", JCGT 2014)

struct ReceiverPicture {
  // Depth is scale + offset / t, where t is the distance along the camera's axis: of a projection z_clip = scale t +
  // offset, w = t. Reversed and without a far plane: 0 and the near distance.
  float depthScale;
  float depthOffset;
  float emptyDepth;  // what pixels hold that see nothing
  int normals;       // kReceiverNormals*
};

// Metres along the camera's axis.
GNOMON_FN float distanceOfDepth(ReceiverPicture picture, float depth) {
  return picture.depthOffset / (depth - picture.depthScale);
}

GNOMON_FN float signNotZero(float x) { return x >= 0.0f ? 1.0f : -1.0f; }

// Not unit.
GNOMON_FN vec3 decodedNormal(ReceiverPicture picture, vec4 texel) {
  if (picture.normals == kReceiverNormalsUnorm) return vec3(texel) * 2.0f - vec3(1.0f, 1.0f, 1.0f);
  if (picture.normals != kReceiverNormalsOctahedral) return vec3(texel);
  float z = 1.0f - abs(texel.x) - abs(texel.y);
  if (z >= 0.0f) return vec3(texel.x, texel.y, z);
  return vec3((1.0f - abs(texel.y)) * signNotZero(texel.x), (1.0f - abs(texel.x)) * signNotZero(texel.y), z);
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::ReceiverPicture) == 16);
#endif
#endif
