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
  int epsilonAt;     // kEpsilonAt*, of the adaptive methods
  int witnessReach;  // texels a side that witness asks: 2 or 4
  int priorityId;    // kPriority*, of the priority buffers
};

const int kEpsilonAtFragment = 0;
const int kEpsilonAtOccluder = 1;
const int kEpsilonAtStored = 2;

const int kPriorityTriangle = 0;
const int kPriorityInstance = 1;
const int kPrioritySheet = 2;

// How a walk of `witness` ends (shared/sheet_walk.glsl), from triangle T towards the point P of the receiver's, R.
const int kWalkReceiver = 0;  // at R: the surface is the receiver's own up to P
const int kWalkWitness = 1;   // at T*, which covers P's direction and lies before R's plane: it shadows P
const int kWalkBehind = 2;    // at T*, which does not
const int kWalkHole = 3;      // at T*, which would, but for a hole of its alpha mask
const int kWalkOpen = 4;      // at an edge that leads nowhere: a silhouette of the surface
const int kWalkFold = 5;      // at an edge behind which the surface turns back: another
const int kWalkAborted = 6;   // after kMostWalkSteps
const int kWalkEndCount = 7;

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

// Of shared/surface_bias.glsl, from here on.
const int kFirstSurfaceBias = 64;
const int kBiasTwoPlane = 64;
const int kBiasTwoPlaneDepth = 65;
const int kBiasWitness = 66;
const int kBiasPriorityBuffer = 67;
const int kBiasPriorityDepth = 68;

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::BiasParams) == (gnomon::glsl::kMostKnobs + 3) * 4);
#endif
#endif
