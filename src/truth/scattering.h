#pragma once
// The light that reaches the eye along one view ray by a single scattering of one point light, given which
// parts of the ray the light reaches. Double precision throughout; media_reference.h finds the parts.
//
//            P                    The plane of the eye E, the light L and the view ray. s runs along the ray from
//           / \                   E; `ahead` is where the ray passes L nearest and `aside` how near; phi is the
//        r /   \ s                angle at L, from 0 at the eye:
//         /phi  \                   tan phi = s aside / (D^2 - s ahead),   ds / r^2 = d phi / aside
//        L-------E
//            D

#include "truth/media_reference.h"

namespace gnomon {

struct ScatteringRay {
  RayD view;
  MediaLight light;
  double eyeDistance = 0.0;           // D, metres
  double ahead = 0.0, aside = 0.0;    // metres; aside > 0
  double sFrom = 0.0, sTo = 0.0;      // metres: where there is a medium
  double phiFrom = 0.0, phiTo = 0.0;  // the same, radians

  double phiAt(double s) const;
  double sAt(double phi) const;
  glm::dvec3 pointAt(double phi) const { return view.origin + view.dir * sAt(phi); }
};

// The ray up to `end` metres, cut to the density's bounds where there is one: empty (sFrom == sTo) where it
// misses them. The eye must not stand at the light.
ScatteringRay scatteringRay(const RayD& view, double end, const MediaLight& light, const MediumModel& medium);

// Where the ray enters and leaves a spot's cone, radians of phi, ascending; empty for a point light.
std::vector<double> coneCrossings(const ScatteringRay& ray);

// A stretch of the ray that the light reaches, radians of phi.
struct LitPiece {
  double from = 0.0, to = 0.0;
};

// Of a homogeneous medium, cd/m^2: adaptive quadrature, each piece to within `tolerance` (infinity: one rule a piece).
glm::dvec3 scatterHomogeneous(const ScatteringRay& ray, std::span<const LitPiece> pieces, const MediumModel& medium,
                              double tolerance);

// What scatters along a ray through a density, at nodes: between two of them it is taken for linear in phi. A
// node is worked out when light first reaches it, so that other pieces of the same ray cost next to nothing.
class DensityProfile {
 public:
  // Nodes at most `step` metres apart, and at least `cells` of equal phi between them; as fine towards the light.
  DensityProfile(const ScatteringRay& ray, const MediumModel& medium, double step, int cells);

  // cd/m^2. The ray and the medium are those of the constructor.
  glm::dvec3 scatter(const ScatteringRay& ray, const MediumModel& medium, std::span<const LitPiece> pieces);

 private:
  struct Node {
    double s = 0.0, phi = 0.0;
    double density = 0.0, towardsEye = 0.0;  // the density's integral over the metres to the eye
    bool known = false;
    glm::dvec3 value{0.0};  // of the integrand over phi, without sigmaS, intensity and aside
  };
  const glm::dvec3& valueAt(Node& node, const ScatteringRay& ray, const MediumModel& medium) const;

  double step_ = 0.0;  // metres
  std::vector<Node> nodes_;
};

// The most that a radian of phi can give, in any channel: cd/m^2.
double largestShare(const ScatteringRay& ray, const MediumModel& medium);

// Optical depth at density 1 per metre: the integral of the density between two points, in steps of `step` metres.
double densityBetween(const DensityField& density, const glm::dvec3& fromW, const glm::dvec3& toW, double step);

// Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93 (1941), equation 2; 1/sr.
double phaseFunction(double g, double cosTurned);

}  // namespace gnomon
