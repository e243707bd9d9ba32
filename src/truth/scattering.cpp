#include "truth/scattering.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/gtx/component_wise.hpp>

namespace gnomon {

namespace {

// A ray that passes the light nearer than this share of D looks straight at it as far as the camera's floats
// can tell (they know a direction to 2^-24); what scatters right there would be infinite.
constexpr double kLeastAside = 0x1p-26;

// Gauss and Kronrod's rule of 15 points, which contains Gauss's of 7: abscissae on [-1, 1] from the outermost to the
// middle, and both weights (Piessens, de Doncker-Kapenga, Ueberhuber, Kahaner, "QUADPACK", 1983, QK15).
constexpr std::array kKronrodAt = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                   0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                   0.586087235467691130294144691693170, 0.405845151377397166906606412076961,
                                   0.207784955007898467600689403773245, 0.0};
constexpr std::array kKronrodWeight = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                       0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                       0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                       0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array kGaussWeight = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                     0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

constexpr int kMostHalvings = 30;  // of a piece's quadrature: to 1e-9 of it

glm::dvec3 transmittance(const glm::dvec3& sigmaT, double length) {
  if (sigmaT.x == sigmaT.y && sigmaT.x == sigmaT.z) return glm::dvec3(std::exp(-sigmaT.x * length));
  return glm::exp(-sigmaT * length);
}

// Where on the view ray a phi lies.
struct Place {
  double s = 0.0, r = 0.0;  // metres from the eye and from the light
  double phase = 0.0;       // 1/sr
};

Place placeAt(const ScatteringRay& ray, double g, double phi) {
  Place place{.s = ray.sAt(phi)};
  const double along = place.s - ray.ahead;
  place.r = std::hypot(along, ray.aside);
  // From the light to the point and on to the eye: against the view ray.
  place.phase = phaseFunction(g, -along / place.r);
  return place;
}

struct Estimate {
  glm::dvec3 value{0.0}, error{0.0};
};

class Quadrature {
 public:
  Quadrature(const ScatteringRay& ray, const MediumModel& medium)
      : ray_(ray), g_(medium.g), sigmaT_(medium.sigmaS + medium.sigmaA) {}

  // Halves where the two rules disagree by more than the tolerance.
  glm::dvec3 over(double from, double to, double tolerance, int halvings) const {
    const Estimate whole = rule(from, to);
    if (halvings == 0 || !(glm::compMax(whole.error) > tolerance)) return whole.value;
    const double middle = 0.5 * (from + to);
    return over(from, middle, 0.5 * tolerance, halvings - 1) + over(middle, to, 0.5 * tolerance, halvings - 1);
  }

 private:
  glm::dvec3 at(double phi) const {
    const Place place = placeAt(ray_, g_, phi);
    return transmittance(sigmaT_, place.s + place.r) * place.phase;
  }

  Estimate rule(double from, double to) const {
    const double center = 0.5 * (from + to), half = 0.5 * (to - from);
    const glm::dvec3 middle = at(center);
    glm::dvec3 kronrod = middle * kKronrodWeight[7], gauss = middle * kGaussWeight[3];
    for (size_t i = 0; i < 7; ++i) {
      const glm::dvec3 pair = at(center - half * kKronrodAt[i]) + at(center + half * kKronrodAt[i]);
      kronrod += pair * kKronrodWeight[i];
      if (i % 2 == 1) gauss += pair * kGaussWeight[i / 2];
    }
    return {kronrod * half, glm::abs(kronrod - gauss) * half};
  }

  const ScatteringRay& ray_;
  double g_;
  glm::dvec3 sigmaT_;
};

// The part of a line within a box, metres from `origin`; from == to where there is none.
struct Stretch {
  double from = 0.0, to = 0.0;
};
Stretch cutToBounds(const RayD& ray, double end, const Bounds& bounds) {
  Stretch cut{0.0, end};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = bounds.lower[axis] - ray.origin[axis], upper = bounds.upper[axis] - ray.origin[axis];
    if (ray.dir[axis] == 0.0) {
      if (lower > 0.0 || upper < 0.0) return {};
      continue;
    }
    const double a = lower / ray.dir[axis], b = upper / ray.dir[axis];
    cut.from = std::max(cut.from, std::min(a, b));
    cut.to = std::min(cut.to, std::max(a, b));
  }
  return cut.from < cut.to ? cut : Stretch{};
}

// Distances that cut the ray's stretch into equal steps and into equal angles, both at once: density varies
// with the one, the light with the other.
std::vector<double> nodeDistances(const ScatteringRay& ray, double step, int cells) {
  std::vector<double> at;
  const int steps = std::max(1, static_cast<int>(std::ceil((ray.sTo - ray.sFrom) / step)));
  for (int i = 0; i <= steps; ++i) at.push_back(ray.sFrom + (ray.sTo - ray.sFrom) * i / steps);
  for (int i = 1; i < cells; ++i) {
    const double s = ray.sAt(ray.phiFrom + (ray.phiTo - ray.phiFrom) * i / cells);
    if (s > ray.sFrom && s < ray.sTo) at.push_back(s);
  }
  std::ranges::sort(at);
  return at;
}

// What of [from, to] is lit: how much, and its centre.
struct Overlap {
  double length = 0.0, center = 0.0;
};
Overlap overlap(std::span<const LitPiece> pieces, size_t& first, double from, double to) {
  Overlap lit;
  while (first < pieces.size() && pieces[first].to <= from) ++first;
  for (size_t i = first; i < pieces.size() && pieces[i].from < to; ++i) {
    const double a = std::max(from, pieces[i].from), b = std::min(to, pieces[i].to);
    lit.length += b - a;
    lit.center += 0.5 * (a + b) * (b - a);
  }
  if (lit.length > 0.0) lit.center /= lit.length;
  return lit;
}

}  // namespace

double phaseFunction(double g, double cosTurned) {
  const double base = 1.0 + g * g - 2.0 * g * cosTurned;
  return (1.0 - g * g) / (4.0 * std::numbers::pi * base * std::sqrt(base));
}

double ScatteringRay::phiAt(double s) const {
  return std::atan2(s * aside, eyeDistance * eyeDistance - s * ahead);
}

double ScatteringRay::sAt(double phi) const {
  const double sine = std::sin(phi);
  return eyeDistance * eyeDistance * sine / (aside * std::cos(phi) + ahead * sine);
}

ScatteringRay scatteringRay(const RayD& view, double end, const MediaLight& light, const MediumModel& medium) {
  const glm::dvec3 toLight = light.positionW - view.origin;
  ScatteringRay ray{.view = view, .light = light, .eyeDistance = glm::length(toLight)};
  GNOMON_CHECK_LT(0.0, ray.eyeDistance);
  ray.ahead = glm::dot(toLight, view.dir);
  ray.aside = std::max(glm::length(glm::cross(toLight, view.dir)), kLeastAside * ray.eyeDistance);
  // `ahead` and `aside` make up D to the last bit: sAt leans on it near the light.
  ray.eyeDistance = std::hypot(ray.ahead, ray.aside);
  const Stretch cut = medium.density != nullptr ? cutToBounds(view, end, medium.density->boundsW()) : Stretch{0.0, end};
  ray.sFrom = cut.from;
  ray.sTo = cut.to;
  ray.phiFrom = ray.phiAt(cut.from);
  ray.phiTo = ray.phiAt(cut.to);
  return ray;
}

// (a + s b)^2 = cos^2 |P - L|^2 with a + s b the height along the axis; roots behind the light's back lie on
// the other half of the double cone and do no harm.
std::vector<double> coneCrossings(const ScatteringRay& ray) {
  if (ray.light.cosCone <= -1.0) return {};
  const glm::dvec3 fromLight = ray.view.origin - ray.light.positionW;
  const double a = glm::dot(fromLight, ray.light.axisW), b = glm::dot(ray.view.dir, ray.light.axisW);
  const double c2 = ray.light.cosCone * ray.light.cosCone;
  const double square = b * b - c2, half = a * b + c2 * ray.ahead;
  const double constant = a * a - c2 * ray.eyeDistance * ray.eyeDistance;
  const double root = std::sqrt(half * half - square * constant);  // NaN where there is no crossing
  std::vector<double> phis;
  for (const double sign : {-1.0, 1.0}) {
    const double s = (-half + sign * root) / square;
    if (s > ray.sFrom && s < ray.sTo) phis.push_back(ray.phiAt(s));
  }
  std::ranges::sort(phis);
  return phis;
}

double largestShare(const ScatteringRay& ray, const MediumModel& medium) {
  return glm::compMax(medium.sigmaS * ray.light.intensity) * phaseFunction(std::abs(medium.g), 1.0) / ray.aside;
}

glm::dvec3 scatterHomogeneous(const ScatteringRay& ray, std::span<const LitPiece> pieces, const MediumModel& medium,
                              double tolerance) {
  const glm::dvec3 scale = medium.sigmaS * ray.light.intensity / ray.aside;
  const double largest = glm::compMax(scale);
  if (!(largest > 0.0)) return glm::dvec3(0.0);
  const Quadrature quadrature(ray, medium);
  glm::dvec3 sum(0.0);
  for (const LitPiece& piece : pieces) sum += quadrature.over(piece.from, piece.to, tolerance / largest, kMostHalvings);
  return sum * scale;
}

double densityBetween(const DensityField& density, const glm::dvec3& fromW, const glm::dvec3& toW, double step) {
  const double length = glm::length(toW - fromW);
  if (!(length > 0.0)) return 0.0;
  const RayD ray{fromW, (toW - fromW) / length};
  const Stretch cut = cutToBounds(ray, length, density.boundsW());
  const int steps = static_cast<int>(std::ceil((cut.to - cut.from) / step));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += density.at(ray.origin + ray.dir * (cut.from + (cut.to - cut.from) * (i + 0.5) / steps));
  return steps > 0 ? sum * (cut.to - cut.from) / steps : 0.0;
}

DensityProfile::DensityProfile(const ScatteringRay& ray, const MediumModel& medium, double step, int cells)
    : step_(step) {
  double towardsEye = 0.0;
  for (const double s : nodeDistances(ray, step, cells)) {
    Node node{.s = s, .phi = ray.phiAt(s), .density = medium.density->at(ray.view.origin + ray.view.dir * s)};
    if (!nodes_.empty()) towardsEye += 0.5 * (nodes_.back().density + node.density) * (s - nodes_.back().s);
    node.towardsEye = towardsEye;
    nodes_.push_back(node);
  }
}

const glm::dvec3& DensityProfile::valueAt(Node& node, const ScatteringRay& ray, const MediumModel& medium) const {
  if (node.known) return node.value;
  node.known = true;
  if (!(node.density > 0.0)) return node.value;
  const Place place = placeAt(ray, medium.g, node.phi);
  const double towardsLight =
      densityBetween(*medium.density, ray.light.positionW, ray.view.origin + ray.view.dir * node.s, step_);
  node.value =
      transmittance(medium.sigmaS + medium.sigmaA, node.towardsEye + towardsLight) * (node.density * place.phase);
  return node.value;
}

glm::dvec3 DensityProfile::scatter(const ScatteringRay& ray, const MediumModel& medium,
                                   std::span<const LitPiece> pieces) {
  glm::dvec3 sum(0.0);
  size_t piece = 0;
  for (size_t i = 0; i + 1 < nodes_.size() && !pieces.empty(); ++i) {
    Node &near = nodes_[i], &far = nodes_[i + 1];
    const Overlap lit = overlap(pieces, piece, near.phi, far.phi);
    if (!(lit.length > 0.0) || (near.density == 0.0 && far.density == 0.0)) continue;
    const double share = (lit.center - near.phi) / (far.phi - near.phi);
    sum += glm::mix(valueAt(near, ray, medium), valueAt(far, ray, medium), share) * lit.length;
  }
  return sum * medium.sigmaS * ray.light.intensity / ray.aside;
}

}  // namespace gnomon
