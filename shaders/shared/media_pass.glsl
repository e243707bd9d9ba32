// Bindings and uniforms of the shaders that integrate a medium, beside those of shade.glsl and volume.glsl.
#ifndef GNOMON_MEDIA_PASS_GLSL
#define GNOMON_MEDIA_PASS_GLSL

#include "shared/density.glsl"
#include "shared/lang.glsl"
#include "shared/medium.glsl"
#include "shared/scene.glsl"

GNOMON_SHARED_BEGIN

const int kBindMedia = 20;        // MediaUniforms
const int kBindRunning = 21;      // the running integral: rgba32f, columns by rows
const int kBindInScattered = 22;  // vec3 a pixel, cd/m^2
const int kBindSurface = 23;      // vec3 a pixel, cd/m^2: surfaces, seen through the medium
const int kBindMediaRadiance = 24;  // vec3 a pixel, cd/m^2: both

const int kBindDensity = 25;      // a NanoVDB grid
const int kBindDensityPlace = 26; // DensityPlace
const int kBindLightDepth = 27;   // float a direction and radius about the light: metres times density
const int kBindEyeDepth = 28;     // float a pixel: metres times density to the view ray's end

const int kMediaGroupSide = 8;    // pixels; the work group is square
const int kTableGroupSize = 8;    // rows of the table

// Of the table of the running integral. Rows between the volume's lowest and highest alpha, both of which have one.
// Swept against double quadratures without occluders (D 0.1 to 30 m, rays to 20 m, sigmaT 0.002 to 0.3 /m, g 0.2 and
// 0.8, 0.9 rad of alpha in front, aside, and to the antipode): with 257 rows a ray's whole is within 8.3e-4 of itself,
// 2e-5 rms; 129 rows: 3.4e-3; 257 columns: 2.5e-3; 513 rows: no better. In thicker fog (0.6 /m, g -0.6) 257 rows are
// off by 1.6e-3 beside the light, and half as many again stay below 1e-3 there, too.
const int kTableRows = 385;
const int kTableColumns = 513;

// Of the table of density between the light and points about it: directions a side of a slice, whose outer ones lie on
// its border, and radii. Turbulence of 128 voxels along the scene with the lamp amid it, rms of the picture against
// depths summed anew, in thousandths of the mean: 1.6; 64 radii of 64 x 64: 5.1; 32 radii of 128 x 128: 3.1, of 64 x
// 64: 5.8, 16 of 32 x 32: 25.
const int kLightDepthSide = 128;
const int kLightDepthRadii = 64;

GNOMON_FN uint lightDepthIndex(int slice, int radius, int x, int y) {
  return uint(((slice * kLightDepthRadii + radius) * kLightDepthSide + y) * kLightDepthSide + x);
}

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

struct DensityPush {
  MediaPush light;
  LightReach reach;
};

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::MediaUniforms) == 160);
static_assert(sizeof(gnomon::glsl::MediaPush) == 48);
static_assert(sizeof(gnomon::glsl::DensityPush) == 80);
#endif
#endif
