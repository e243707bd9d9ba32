// What the tests of the medium evaluate on both sides.
#ifndef GNOMON_TEST_MEDIUM_FUNCTIONS_GLSL
#define GNOMON_TEST_MEDIUM_FUNCTIONS_GLSL

#include "shared/density.glsl"
#include "shared/medium.glsl"

GNOMON_SHARED_BEGIN

struct MediumQuery {
  Medium medium;
  vec3 fromLight;
  vec3 dir;
  float eyeDistance;
  float alpha;
  float phi;
};

struct MediumAnswer {
  float phase;     // by the cosine of alpha
  vec3 perMetre;   // without extinction: depth 0
  vec3 dimmed;     // transmittance over a metre of phi
  vec3 integrand;
  vec2 uv;         // of dir in a density's table
  int slice;
  vec3 dirAgain;
};

GNOMON_FN MediumAnswer mediumAnswer(MediumQuery query) {
  MediumAnswer answer;
  answer.phase = phaseFunction(query.medium.g, query.dir.x);
  answer.perMetre = scatteredPerMetre(query.medium, query.fromLight, query.dir, 0.0f);
  answer.dimmed = transmittance(query.medium, query.phi);
  answer.integrand = scatteringIntegrand(query.medium, query.eyeDistance, query.alpha, query.phi);
  LightReach reach;
  reach.axisW = unitVector(query.fromLight);
  reach.halfWidth = 1.0f;
  reach.layers = 2;
  LightDirection direction = lightDirection(reach, query.dir);
  answer.uv = direction.uv;
  answer.slice = direction.slice;
  answer.dirAgain = directionFromLight(reach, direction.slice, direction.uv);
  return answer;
}

GNOMON_SHARED_END
#endif
