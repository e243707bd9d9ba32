// A homogeneous participating medium lit by a point light, single scattering. What both processors compute of it.
//
//   L(x) = integral over s in [0, end] of  sigmaS p(cos t) I / r^2  exp(-sigmaT (s + r))  V(s)  ds
//
// s is the distance from the eye along a unit view ray, r that from the light, I the light's intensity (candela, times
// its colour), V whether the light reaches the point, t the angle by which light is turned there, p the phase function
// (1/sr), sigmaT = sigmaS + sigmaA. L is in cd/m^2.
//
// In epipolar coordinates (shared/epipolar.glsl) s = D sin phi / sin(phi + alpha) and r = D sin alpha / sin(phi +
// alpha), so that ds / r^2 = d phi / (D sin alpha), t = phi + alpha, and s + r = D cos((phi - alpha) / 2) /
// cos((phi + alpha) / 2):
//
//   L = sigmaS I / (D sin alpha)
//     integral over phi of  p(cos(phi + alpha)) exp(-sigmaT D cos((phi - alpha) / 2) / cos((phi + alpha) / 2)) V d phi
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

// Henyey and Greenstein, "Diffuse radiation in the galaxy", Astrophysical Journal 93, 1941: per steradian, by the
// cosine of the angle by which light is turned. The lower bound is what the sum is where light goes straight on, and
// rounding may not pass it.
GNOMON_FN float phaseFunction(float g, float cosTurn) {
  float away = 1.0f - abs(g);
  GNOMON_PRECISE float x = max(1.0f + g * g - 2.0f * g * cosTurn, away * away);
  GNOMON_PRECISE float phase = (1.0f - g * g) / (4.0f * kPi * (x * sqrt(x)));
  return phase;
}

GNOMON_FN vec3 extinction(Medium medium) { return medium.sigmaS + medium.sigmaA; }

// Of light over `depth`: metres where the medium is homogeneous, else metres times density.
GNOMON_FN vec3 transmittance(Medium medium, float depth) { return exp(extinction(medium) * -depth); }

// What a metre of a view ray at density 1 scatters towards the eye, of a light of 1 cd a metre away with nothing
// between, attenuated by `depth` in all.
// `fromLight`: from the light to the point, metres. `dir`: the view ray's, unit.
GNOMON_FN vec3 scatteredAtUnitDistance(Medium medium, vec3 fromLight, vec3 dir, float depth) {
  float cosTurn = -dot(fromLight, dir) / sqrt(max(dot(fromLight, fromLight), 1e-12f));
  return medium.sigmaS * transmittance(medium, depth) * phaseFunction(medium.g, cosTurn);
}

// The same of the light where it is. A sample that falls into the lamp itself, nearer than a micrometre, is as bright
// as one there.
GNOMON_FN vec3 scatteredPerMetre(Medium medium, vec3 fromLight, vec3 dir, float depth) {
  return scatteredAtUnitDistance(medium, fromLight, dir, depth) * (1.0f / max(dot(fromLight, fromLight), 1e-12f));
}

// phi of the point `s` metres from the eye on the view ray of alpha.
GNOMON_FN float phiOnViewRay(float eyeDistance, float sinAlpha, float cosAlpha, float s) {
  return atan2(s * sinAlpha, eyeDistance - s * cosAlpha);
}

// The integrand over phi, without sigmaS I / (D sin alpha): p exp(-sigmaT (s + r)), 1/sr. Nothing comes from where the
// view ray has no points.
GNOMON_FN vec3 scatteringIntegrand(Medium medium, float eyeDistance, float alpha, float phi) {
  float turn = phi + alpha;
  float down = cos(0.5f * turn);
  if (!(turn < kPi && down > 0.0f)) return vec3(0.0f, 0.0f, 0.0f);
  float path = eyeDistance * cos(0.5f * (phi - alpha)) / down;
  return transmittance(medium, path) * phaseFunction(medium.g, cos(turn));
}

// The integral over a stretch of phi by Gauss and Legendre's rule of two points.
GNOMON_FN vec3 scatteringBetween(Medium medium, float eyeDistance, float alpha, float phiBegin, float phiEnd) {
  float middle = 0.5f * (phiBegin + phiEnd);
  float half_ = 0.5f * (phiEnd - phiBegin);
  float node = half_ * 0.577350269f;  // 1 / sqrt(3)
  return (scatteringIntegrand(medium, eyeDistance, alpha, middle - node) +
          scatteringIntegrand(medium, eyeDistance, alpha, middle + node)) *
         half_;
}

// The running integral over phi from 0 is tabulated: rows of equal alpha, columns of equal share of the phi that the
// row has in the volume, which ends at `phiUpper`, and where the view ray looks away from the light, at pi - alpha.
// There all of the integrand shrinks with that end, and columns that did not would miss it.
GNOMON_FN float phiOfLastColumn(float phiUpper, float alpha) { return min(phiUpper, kPi - alpha); }

// sigmaS / (D sin alpha), the factor of the integral over phi, 1/m^2. Towards the light itself the integral diverges; a
// direction is good to 2^-23, and nearer to the light than that the ray is taken to pass it at that angle.
GNOMON_FN vec3 scatteringFactor(Medium medium, float eyeDistance, float sinAlpha) {
  return medium.sigmaS * (1.0f / (eyeDistance * max(sinAlpha, 1.2e-7f)));
}

// A stretch of a view ray, radians of phi; nothing where end <= begin.
struct PhiRange {
  float begin;
  float end;
};

// What a cone about the light lets through of a view ray from phi = 0 to `end`: light rays at phi have the cosine A sin
// phi + B cos phi = C cos(phi - atan2(A, B)) with its axis. `outward`: unit, the way in which the view ray leaves the
// axis of L. coneCos >= 0, so that what is within is one stretch; -1 is no cone.
GNOMON_FN PhiRange phiWithinCone(vec3 coneAxisL, float coneCos, vec2 outward, float end) {
  PhiRange range;
  range.begin = 0.0f;
  range.end = end;
  if (coneCos <= -1.0f) return range;
  float a = coneAxisL.x * outward.x + coneAxisL.y * outward.y;
  float b = coneAxisL.z;
  float rest = a * a + b * b - coneCos * coneCos;
  if (!(rest > 0.0f)) {
    range.end = 0.0f;
    return range;
  }
  float middle = atan2(a, b);
  float half_ = atan2(sqrt(rest), coneCos);
  if (middle + half_ < 0.0f) middle = middle + 2.0f * kPi;
  range.begin = max(middle - half_, 0.0f);
  range.end = min(middle + half_, end);
  return range;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::Medium) == 32);
#endif
#endif
