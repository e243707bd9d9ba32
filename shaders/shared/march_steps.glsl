// How a view ray is cut into steps where a medium's density varies. Half of the cuts stand at equal distances, which
// find what the density does; half at equal angles seen from the light, where 1 / r^2 is flat: equiangular sampling,
// Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media", EGSR 2012. No step is
// longer than the ray over half their number.
#ifndef GNOMON_MARCH_STEPS_GLSL
#define GNOMON_MARCH_STEPS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Distances are metres along the ray.
struct MarchSteps {
  float begin;
  float end;
  float foot;        // where the ray passes the light
  float aside;       // of the light there, for the cuts: at least one step, or all would fall into the lamp
  float firstAngle;  // of the begin, seen from the light; the foot is at 0
  float angleStep;
  int equal;         // stretches of equal distance
  int angular;       // and of equal angle: one more than steps together
  int nextEqual;
  int nextAngular;
};

// `steps` >= 1 from `begin` to `end`; the light is `aside` from the ray at `foot`.
GNOMON_FN MarchSteps marchSteps(float begin, float end, float foot, float aside, int steps) {
  MarchSteps march;
  march.begin = begin;
  march.end = end;
  march.foot = foot;
  march.equal = (steps + 2) / 2;
  march.angular = steps + 1 - march.equal;
  march.aside = max(aside, (end - begin) / float(steps));
  march.firstAngle = atan2(begin - foot, march.aside);
  march.angleStep = (atan2(end - foot, march.aside) - march.firstAngle) / float(march.angular);
  march.nextEqual = 1;
  march.nextAngular = 1;
  return march;
}

// The end of the next step; of the last, the ray's own.
GNOMON_FN float nextStepEnd(GNOMON_INOUT(MarchSteps) march) {
  float byDistance = march.begin + (march.end - march.begin) * (float(march.nextEqual) / float(march.equal));
  float byAngle = march.foot + march.aside * tan(march.firstAngle + march.angleStep * float(march.nextAngular));
  if (march.nextAngular < march.angular && byAngle < byDistance) {
    march.nextAngular = march.nextAngular + 1;
    return clamp(byAngle, march.begin, march.end);
  }
  march.nextEqual = march.nextEqual + 1;
  return march.nextEqual > march.equal ? march.end : byDistance;
}

// The distance, from the foot, that halves the angle under which the light sees the stretch from `a` to `b`, metres
// from the foot; `aside` > 0.
GNOMON_FN float middleByAngle(float a, float b, float aside) {
  float ra = sqrt(aside * aside + a * a);
  float rb = sqrt(aside * aside + b * b);
  return (a * rb + b * ra) / (ra + rb);
}

// The integral of 1 / r^2 over that stretch, 1/m: its angle over `aside`. Where the angle is small, its tangent is the
// angle, to a third of 10^-6.
GNOMON_FN float inverseSquareBetween(float a, float b, float aside) {
  float across = aside * (b - a);
  float along = aside * aside + a * b;
  return along > 1e3f * across ? (b - a) / along : atan2(across, along) / aside;
}

GNOMON_SHARED_END

#endif
