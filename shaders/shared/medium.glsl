// A homogeneous participating medium lit by a point light, single scattering. What both processors compute of it.
//
//   L(x) = integral over s in [0, end] of  sigmaS p(cos t) I / r^2  exp(-sigmaT (s + r))  V(s)  ds
//
// s is the distance from the eye along a unit view ray, r that from the light, I the light's intensity (candela, times its colour), V whether the light
// reaches the point, t the angle by which light is turned there, p the phase function (1/sr), sigmaT = sigmaS + sigmaA. L is in cd/m^2.
//
// In epipolar coordinates (shared/epipolar.glsl) s = D sin phi / sin(phi + alpha) and r = D sin alpha / sin(phi + alpha), so that
// ds / r^2 = d phi / (D sin alpha), t = phi + alpha, and s + r = D cos((phi - alpha) / 2) / cos((phi + alpha) / 2):
//
//   L = sigmaS I / (D sin alpha)  integral over phi of  p(cos(phi + alpha)) exp(-sigmaT D cos((phi - alpha) / 2) / cos((phi + alpha) / 2))  V  d phi
//
// where nothing but V depends on theta: the running integral over phi is one table for all view rays of a frame.
#ifndef GNOMON_MEDIUM_GLSL
#define GNOMON_MEDIUM_GLSL

#include "shared/epipolar.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// With a density grid, sigmaS and sigmaA are those at density 1.
struct Medium {
  vec3 sigmaS;  // scattering, 1/m, a colour channel each
  vec3 sigmaA;  // absorption, 1/m
  float g;      // mean cosine of Henyey and Greenstein's phase function, in (-1, 1)
  float reach;  // metres from the eye: view rays that meet no surface before it end there
};

GNOMON_SHARED_END
#endif
