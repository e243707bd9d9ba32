// The biases' ids and parameters, without their code (bias.glsl), so that a change to a bias rebuilds no C++ but tests.
#ifndef GNOMON_BIAS_PARAMS_GLSL
#define GNOMON_BIAS_PARAMS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kMostKnobs = 4;

// The parameters of one method. Its row in src/shadow/bias.cpp lists its knobs, in this order, with names, units,
// ranges and defaults; its file in bias/ names their places.
struct BiasParams {
  float knobs[kMostKnobs];
  int epsilonAt;  // kEpsilonAt*, of the adaptive methods
};

const int kEpsilonAtFragment = 0;
const int kEpsilonAtOccluder = 1;
const int kEpsilonAtStored = 2;

const int kBiasNone = 0;
const int kBiasConstant = 1;
const int kBiasSlope = 2;
const int kBiasAdaptive = 3;
const int kBiasNormalOffset = 4;
const int kBiasCosine = 5;
const int kBiasReceiverPlane = 6;
const int kBiasSecondDepth = 7;
const int kBiasMidpoint = 8;
const int kBiasDual = 9;
const int kBiasAdaptiveClamped = 10;
const int kBiasAdaptiveEhm = 11;
const int kBiasUser = 12;  // bias/user.glsl, which --bias-file replaces
// What engines do by themselves.
const int kBiasEevee = 32;
const int kBiasGodot = 33;
const int kBiasBevy = 34;
const int kBiasUnrealVsm = 35;

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::BiasParams) == (gnomon::glsl::kMostKnobs + 1) * 4);
#endif
#endif
