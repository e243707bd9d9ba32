// Bindings and uniforms of the shaders that integrate a medium, beside those of shade.glsl and volume.glsl.
#ifndef GNOMON_MEDIA_PASS_GLSL
#define GNOMON_MEDIA_PASS_GLSL

#include "shared/lang.glsl"
#include "shared/medium.glsl"
#include "shared/scene.glsl"

GNOMON_SHARED_BEGIN

const int kBindMedia = 20;        // MediaUniforms
const int kBindRunning = 21;      // the running integral: rgba32f, columns by rows
const int kBindInScattered = 22;  // vec3 a pixel, cd/m^2
const int kBindSurface = 23;      // vec3 a pixel, cd/m^2: surfaces, seen through the medium
const int kBindMediaRadiance = 24;  // vec3 a pixel, cd/m^2: both

const int kMediaGroupSide = 8;    // pixels; the work group is square
const int kTableGroupSize = 8;    // rows of the table

// How bits are integrated.
const int kIntegrateRuns = 0;
const int kIntegrateBits = 1;
const int kIntegratePopcount = 2;

// Of the table of the running integral. Rows between the volume's lowest and highest alpha, both of which have one.
const int kTableRows = 513;
const int kTableColumns = 513;

struct MediaUniforms {
  CameraView camera;
  Medium medium;
};

// Push constants: the light, and how to march.
struct MediaPush {
  vec3 lightW;     // metres
  vec3 intensity;  // candela
  vec3 coneAxisW;  // unit, the way a spot light shines
  float coneCos;   // of its half angle; -1 where there is no cone
  int steps;
  int add;         // 1: to what other lights scattered
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::MediaUniforms) == 160);
static_assert(sizeof(gnomon::glsl::MediaPush) == 48);
#endif
#endif
