// What a triangle covers of the columns (theta, phi) of a shadow volume, as a box for the rasterizer. It may enclose
// more, since each column is decided by its own ray (ray_triangle.glsl), never less.
//
// Phi is extreme at a corner, where an edge's great circle passes a pole nearest, or at a pole inside. Theta runs one
// way along a great circle (its rate is n.z / sin^2 phi, n the circle's normal), so that it is extreme at corners; a
// triangle that holds no pole spans less than half a turn of it, one that holds a pole all of it.
#ifndef GNOMON_EPIPOLAR_BOUND_GLSL
#define GNOMON_EPIPOLAR_BOUND_GLSL

#include "shared/map.glsl"
#include "shared/ray_triangle.glsl"

GNOMON_SHARED_BEGIN

struct EpipolarBox {
  vec2 low, high;  // columns; high.x may lie beyond the last by up to a turn
  bool allRound;
};

// Radians. atan2 is good to 3.3e-6 on the least of the devices, which is more than what rounding a corner turns it.
const float kAngleRounding = 1e-5f;
// Within this angle of a pole a corner's theta is good to 1e-3 only (2^-24 / 1e-4): such a triangle is drawn all round.
const float kPoleReach = 1e-4f;
// More than the error of a corner's theta anywhere else.
const float kThetaDoubt = 1e-2f;

// Whether a triangle holds a pole (0, 0, sign) or comes near to it. Slivers along a meridian lie in the planes of all
// their sides with both poles: they must also hold it in the cap about their middle.
GNOMON_FN bool holdsPole(LightTriangle t, vec3 ua, vec3 ub, vec3 uc, float sign_) {
  bool within = t.sideA.z * sign_ >= -kPoleReach * length(t.sideA) &&
                t.sideB.z * sign_ >= -kPoleReach * length(t.sideB) &&
                t.sideC.z * sign_ >= -kPoleReach * length(t.sideC);
  vec3 middle = ua + ub + uc;
  float least = min(dot(ua, middle), min(dot(ub, middle), dot(uc, middle)));
  return within && (least <= 0.0f || middle.z * sign_ >= least - 2.0f * kPoleReach * length(middle));
}

// The range of phi with what the great circle through p and q adds between them: it passes +z at the angle atan2(|n.z|,
// |n.xy|) in the direction `top`, and -z at the same in the opposite one.
GNOMON_FN vec2 includingArc(vec2 range, vec3 p, vec3 q) {
  vec3 n = edgePlane(p, q);
  vec3 top = vec3(-n.x * n.z, -n.y * n.z, n.x * n.x + n.y * n.y);
  float fromP = dot(cross(n, p), top);
  float toQ = dot(cross(q, n), top);
  float slack = kAngleRounding * length(n) * length(top);
  float nearest = atan2(abs(n.z), sqrt(n.x * n.x + n.y * n.y));
  if (fromP >= -slack * length(p) && toQ >= -slack * length(q)) range.x = min(range.x, nearest);
  if (fromP <= slack * length(p) && toQ <= slack * length(q)) range.y = max(range.y, kPi - nearest);
  return range;
}

GNOMON_FN float phiOf(vec3 d) { return atan2(sqrt(d.x * d.x + d.y * d.y), d.z); }

GNOMON_FN vec2 phiRange(LightTriangle t) {
  float a = phiOf(t.a);
  float b = phiOf(t.b);
  float c = phiOf(t.c);
  vec2 range = vec2(min(a, min(b, c)), max(a, max(b, c)));
  range = includingArc(range, t.a, t.b);
  range = includingArc(range, t.b, t.c);
  return includingArc(range, t.c, t.a);
}

// Lower end and width of the shortest stretch of the circle that holds three angles within [-pi, pi].
GNOMON_FN vec2 shortestStretch(float a, float b, float c) {
  float low = min(a, min(b, c));
  float high = max(a, max(b, c));
  float middle = max(min(a, b), min(max(a, b), c));
  float turn = 2.0f * kPi;
  float round_ = turn - (high - low);
  float first = middle - low;
  float second = high - middle;
  if (round_ >= first && round_ >= second) return vec2(low, high - low);
  if (first >= second) return vec2(middle, turn - first);
  return vec2(high, turn - second);
}

GNOMON_FN EpipolarBox epipolarBox(EpipolarGrid grid, LightTriangle t) {
  vec3 ua = unitVector(t.a);
  vec3 ub = unitVector(t.b);
  vec3 uc = unitVector(t.c);
  bool towardsEye = holdsPole(t, ua, ub, uc, 1.0f);
  bool fromEye = holdsPole(t, ua, ub, uc, -1.0f);
  vec2 phi = phiRange(t);
  if (towardsEye) phi.x = 0.0f;
  if (fromEye) phi.y = kPi;
  vec2 theta = shortestStretch(atan2(t.a.x, t.a.y), atan2(t.b.x, t.b.y), atan2(t.c.x, t.c.y));
  // 1/32 of a column for the rasterizer's own grid of 1/256. Rounding turns theta by more near the poles; no column's
  // centre is nearer to one than half a column.
  float margin = 0.03125f;
  float aside = max(min(sin(phi.x), sin(phi.y)), 0.5f * grid.phiStep);
  float thetaMargin = margin * grid.thetaStep + kAngleRounding / aside;
  float turn = 2.0f * kPi;
  float from = theta.x - thetaMargin - grid.thetaLower;
  from = from - floor(from / turn) * turn;
  EpipolarBox box;
  box.low = vec2(from / grid.thetaStep, (phi.x - kAngleRounding - grid.phiLower) / grid.phiStep - margin);
  box.high = vec2((from + theta.y + 2.0f * thetaMargin) / grid.thetaStep,
                  (phi.y + kAngleRounding - grid.phiLower) / grid.phiStep + margin);
  box.allRound = towardsEye || fromEye || theta.y > kPi - kThetaDoubt;
  if (box.allRound) {
    box.low.x = 0.0f;
    box.high.x = float(grid.thetaCount);
  }
  return box;
}

// Whether a box lies over the seam of theta: its part beyond the last column is drawn once more, a turn lower.
GNOMON_FN bool epipolarBoxOverSeam(EpipolarGrid grid, EpipolarBox box) {
  return !box.allRound && box.high.x > 2.0f * kPi / grid.thetaStep;
}

GNOMON_SHARED_END
#endif
