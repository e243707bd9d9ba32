#include "truth/continuity.h"

#include "truth/triangle.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace gnomon {

namespace {

// Rays spent on one pixel before the rest of the stretch is taken for continuous: about fifty facets, or ten
// places where surfaces meet without being neighbours.
constexpr int kMaxProbes = 96;

// Between two rays of a point light (one origin) or of a directional one (one direction).
RayD halfway(const RayD& a, const RayD& b) {
  return {0.5 * (a.origin + b.origin), glm::normalize(a.dir + b.dir)};
}

struct Stretch {
  Probe a, b;
  int depth = 0;
  double jump = 0.0;  // metres: how far either hit lies off the other's plane; 0 where the stretch is settled
};

// How far two hits are from lying in one plane: a jump of distance that either plane's slope explains counts nothing,
// however steep. Seen side by side, a crease's jump shrinks with the stretch; a silhouette's does not.
double jumpBetween(const Probe& a, const Probe& b) {
  if (!a.hit && !b.hit) return 0.0;
  if (!a.hit || !b.hit) return std::numeric_limits<double>::infinity();
  if (a.hit->primitive == b.hit->primitive) return 0.0;
  const glm::dvec3 apart = b.positionW() - a.positionW();
  return std::max(std::abs(glm::dot(a.hit->normalW, apart)), std::abs(glm::dot(b.hit->normalW, apart)));
}

// --- The judgement at the end of bisection -------------------------------------------------------------
//
// The rays a and b span a plane through the light, the fan. It cuts the two triangles that were hit in two segments:
//
//           light                    light
//            /\                       /\            y: along the rays, x: from a to b
//         a /  \ b                 a /  \ b
//          /    \                   /    \          The segments are clipped to the wedge between the rays.
//       --A------+                --A--   \         In one piece (left: a crease, a corner, a wall on a floor) they
//                 B                     ---B--      touch there; across a silhouette (right) they do not.
//                 |
//
// Neighbours share corners, so their cuts share an end to double precision, at any steepness: nothing has to
// be assumed of slopes. Where the wedge is wider than the facets (an arc that passes a corner of several
// triangles) there are others between the two hit, and a gap is forgiven that surfaces no steeper than the
// two could bridge over the wedge's width. The smallest step seen is thus the margin plus that: between 1 and
// kSteepest thousandths of a texel.

constexpr double kSteepest = 16.0;  // metres along the ray per metre across, together
// Embree's float rays stray by this share of their length; hits may lie that much outside the wedge.
constexpr double kRayNoise = 0x1p-22;

struct Fan {
  glm::dvec3 origin;   // halfway between the rays, at the hits' mean distance
  glm::dvec3 x, y, z;  // unit; z is the fan's normal
  double width = 0.0;  // metres between the rays at the origin
  double reach = 0.0;  // metres from the light to the origin
};

struct Segment {
  glm::dvec2 p, q;
};

Fan makeFan(const Probe& a, const Probe& b) {
  Fan fan;
  fan.reach = 0.5 * (a.hit->distance + b.hit->distance);
  const glm::dvec3 atA = a.ray.origin + a.ray.dir * fan.reach;
  const glm::dvec3 atB = b.ray.origin + b.ray.dir * fan.reach;
  fan.origin = 0.5 * (atA + atB);
  fan.y = glm::normalize(a.ray.dir + b.ray.dir);
  const glm::dvec3 across = (atB - atA) - fan.y * glm::dot(fan.y, atB - atA);
  fan.width = glm::length(across);
  fan.x = fan.width > 0.0 ? across / fan.width : glm::dvec3(0.0);
  fan.z = glm::cross(fan.x, fan.y);
  return fan;
}

glm::dvec2 inFan(const Fan& fan, const glm::dvec3& posW) {
  return {glm::dot(fan.x, posW - fan.origin), glm::dot(fan.y, posW - fan.origin)};
}

// Where the fan's plane cuts a triangle; the hit's own point where it passes by a rounding.
Segment cutTriangle(const Fan& fan, const glm::dvec3 corners[3], const glm::dvec3& hitW) {
  Segment cut{inFan(fan, hitW), inFan(fan, hitW)};
  int found = 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3& from = corners[k];
    const glm::dvec3& to = corners[(k + 1) % 3];
    const double zFrom = glm::dot(fan.z, from - fan.origin);
    const double zTo = glm::dot(fan.z, to - fan.origin);
    if ((zFrom < 0.0) == (zTo < 0.0)) continue;
    (found++ == 0 ? cut.p : cut.q) = inFan(fan, from + (to - from) * (zFrom / (zFrom - zTo)));
  }
  return cut;
}

// Keeps what lies where `atP` (the value at p) to `atQ` is not negative; false where nothing does.
bool clipSegment(Segment& segment, double atP, double atQ) {
  if (atP < 0.0 && atQ < 0.0) return false;
  if (atP >= 0.0 && atQ >= 0.0) return true;
  const glm::dvec2 crossing = segment.p + (segment.q - segment.p) * (atP / (atP - atQ));
  (atP < 0.0 ? segment.p : segment.q) = crossing;
  return true;
}

// Metres that a point lies to the right of a ray.
double rightOf(const Fan& fan, const RayD& ray, const glm::dvec2& point) {
  const glm::dvec2 from = point - inFan(fan, ray.origin);
  const glm::dvec2 dir(glm::dot(fan.x, ray.dir), glm::dot(fan.y, ray.dir));
  return from.x * dir.y - from.y * dir.x;
}

Segment cutInWedge(const Tracer& tracer, const Fan& fan, const Probe& a, const Probe& b, const Probe& of) {
  glm::dvec3 corners[3];
  tracer.corners(of.hit->primitive, corners);
  Segment cut = cutTriangle(fan, corners, of.positionW());
  const double pad = 0.5 * fan.width + kRayNoise * fan.reach;
  const bool inside = clipSegment(cut, cut.p.y + fan.reach, cut.q.y + fan.reach) &&
                      clipSegment(cut, rightOf(fan, a.ray, cut.p) + pad, rightOf(fan, a.ray, cut.q) + pad) &&
                      clipSegment(cut, pad - rightOf(fan, b.ray, cut.p), pad - rightOf(fan, b.ray, cut.q));
  if (!inside) cut.p = cut.q = inFan(fan, of.positionW());
  return cut;
}

double pointToSegment(const glm::dvec2& point, const Segment& segment) {
  const glm::dvec2 along = segment.q - segment.p;
  const double lengthSquared = glm::dot(along, along);
  const double t = lengthSquared > 0.0 ? std::clamp(glm::dot(point - segment.p, along) / lengthSquared, 0.0, 1.0) : 0.0;
  return glm::length(point - (segment.p + along * t));
}

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

double segmentDistance(const Segment& s, const Segment& t) {
  const bool crossS = (cross2(s.q - s.p, t.p - s.p) < 0.0) != (cross2(s.q - s.p, t.q - s.p) < 0.0);
  const bool crossT = (cross2(t.q - t.p, s.p - t.p) < 0.0) != (cross2(t.q - t.p, s.q - t.p) < 0.0);
  if (crossS && crossT) return 0.0;
  return std::min({pointToSegment(s.p, t), pointToSegment(s.q, t), pointToSegment(t.p, s), pointToSegment(t.q, s)});
}

// Metres along the ray per metre across it, on the hit's plane.
double steepness(const Probe& of) {
  const double cosine = std::min(1.0, std::abs(glm::dot(of.hit->normalW, of.ray.dir)));
  return cosine > 0.0 ? std::sqrt(1.0 - cosine * cosine) / cosine : kSteepest;
}

bool joined(const Tracer& tracer, const Probe& a, const Probe& b, double margin) {
  if (!a.hit || !b.hit) return false;
  const Fan fan = makeFan(a, b);
  if (fan.width == 0.0) return true;
  const double gap = segmentDistance(cutInWedge(tracer, fan, a, b, a), cutInWedge(tracer, fan, a, b, b));
  if (gap <= margin) return true;
  const double widest = fan.width * std::max(a.hit->distance, b.hit->distance) / fan.reach;
  return gap <= margin + widest * (1.0 + std::min(steepness(a) + steepness(b), kSteepest));
}

// Whether two hits lie on neighbours: the cuts share an end T, the first triangle ends there and the second begins.
//
//        a      T        b      What is seen from a to T is the one, from T to b the other: one piece, however
//        |      |        |      wide the stretch is. Cuts that touch otherwise (a wall on the middle of a
//      --A------+---B----+--    floor, a table's leg) may hide one another and are left to bisection.
bool neighbours(const Tracer& tracer, const Probe& a, const Probe& b, double margin) {
  if (!a.hit || !b.hit) return false;
  const Fan fan = makeFan(a, b);
  if (fan.width == 0.0) return false;
  glm::dvec3 corners[3];
  tracer.corners(a.hit->primitive, corners);
  const Segment first = cutTriangle(fan, corners, a.positionW());
  tracer.corners(b.hit->primitive, corners);
  const Segment second = cutTriangle(fan, corners, b.positionW());
  const glm::dvec2 light = inFan(fan, a.ray.origin);
  const bool parallel = a.ray.origin != b.ray.origin;
  for (const auto& [end, before] : {std::pair{first.p, first.q}, std::pair{first.q, first.p}}) {
    for (const auto& [begin, after] : {std::pair{second.p, second.q}, std::pair{second.q, second.p}}) {
      if (glm::length(end - begin) > margin) continue;
      const glm::dvec2 along = parallel ? glm::dvec2(0.0, 1.0) : end - light;
      if (cross2(before - end, along) < 0.0 && cross2(after - end, along) > 0.0) return true;
    }
  }
  return false;
}

// --- Bisection -----------------------------------------------------------------------------------------

// Best first: of all stretches not settled yet the one with the largest jump is halved next, so that a
// silhouette is followed to its end before creases are looked at, and one that hides behind a larger crease
// is still found.
class Bisection {
 public:
  Bisection(const Tracer& tracer, double margin) : tracer_(tracer), margin_(margin) {}
  bool empty() const { return count_ == 0; }

  void push(const Probe& a, const Probe& b, int depth) {
    const double jump = jumpBetween(a, b);
    if (jump <= margin_ || neighbours(tracer_, a, b, margin_)) return;
    GNOMON_CHECK_LT(count_, stretches_.size());
    stretches_[count_++] = {a, b, depth, jump};
  }

  Stretch popLargest() {
    const auto end = stretches_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto largest =
        std::max_element(stretches_.begin(), end, [](const Stretch& s, const Stretch& t) { return s.jump < t.jump; });
    Stretch popped = *largest;
    *largest = stretches_[--count_];
    return popped;
  }

 private:
  const Tracer& tracer_;
  double margin_;
  size_t count_ = 0;
  std::array<Stretch, kMaxProbes + 1> stretches_;
};

}  // namespace

Probe probeAlong(const Tracer& tracer, const RayD& ray) {
  return {ray, tracer.firstHit(ray)};
}

bool continuousBetween(const Tracer& tracer, const Probe& a, const Probe& b, double margin) {
  if (jumpBetween(a, b) <= margin) return true;
  Bisection open(tracer, margin);
  open.push(a, b, 0);
  for (int probes = 0; !open.empty() && probes < kMaxProbes;) {
    const Stretch stretch = open.popLargest();
    if (stretch.depth == kBisectionSteps) {
      if (!joined(tracer, stretch.a, stretch.b, margin)) return false;
      continue;
    }
    const Probe middle = probeAlong(tracer, halfway(stretch.a.ray, stretch.b.ray));
    ++probes;
    open.push(stretch.a, middle, stretch.depth + 1);
    open.push(middle, stretch.b, stretch.depth + 1);
  }
  return true;
}

bool continuousBetween(const Tracer& tracer, const RayD& a, const RayD& b, double margin) {
  return continuousBetween(tracer, probeAlong(tracer, a), probeAlong(tracer, b), margin);
}

}  // namespace gnomon
