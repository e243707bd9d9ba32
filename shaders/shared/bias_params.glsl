// The methods and their knobs, without the decisions (bias.glsl), so that a change of a decision rebuilds no C++ but tests.
#ifndef GNOMON_BIAS_PARAMS_GLSL
#define GNOMON_BIAS_PARAMS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Every knob of every method; names, units, ranges and defaults are in src/shadow/bias.cpp.
struct BiasParams {
  float constantOffset;  // metres
  float slopeFactor;     // 1
  float slopeOffset;     // metres
  float adaptiveK;       // 1, of the scene's scale
  int epsilonAt;         // kEpsilonAt*
  float normalOffsetTexels;
  float cosineOffset;         // metres
  float receiverPlaneOffset;  // metres
  float secondDepthOffset;    // metres
  float dualOffset;           // metres
  float userKnob;             // of a user's own bias: its file says what it is
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

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::BiasParams) == 44);
#endif
#endif
