// The plain forward renderer of `gnomon bench` (src/lab/bench/plain_forward.h): its bindings and uniforms.
#ifndef GNOMON_PLAIN_FORWARD_GLSL
#define GNOMON_PLAIN_FORWARD_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindPlain = 0;           // PlainUniforms
const int kBindPlainDistances = 1;  // a cube of depths
const int kBindPlainColor = 2;      // a draw's texture

struct PlainUniforms {
  mat4 clipFromWorld;  // of the camera
  mat4 faceFromWorld[6];
  vec3 lightW;
  float zFar;          // metres: the distance that is stored as 1
  vec3 lightColor;
  float offset;        // metres: the bias
  vec3 ambient;
};

struct PlainPush {
  mat4 worldFromMesh;
  vec4 baseColor;  // linear
  int face;
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::PlainUniforms) == 7 * 64 + 44);
static_assert(sizeof(gnomon::glsl::PlainPush) == 84);
#endif
#endif
