// The mathematics of a medium: against its definitions on the CPU, and the GPU against the CPU.
#include "medium_functions.glsl"
#include "shared/media_pass.glsl"
#include "tests/run_kernel.h"

#include <numbers>
#include <random>

namespace gnomon {
namespace {

using namespace glsl;

TEST(PhaseFunction, IntegratesToOneAndItsMeanCosineIsG) {
  constexpr int kSteps = 200000;
  for (const float g : {-0.9f, -0.3f, 0.0f, 0.2f, 0.85f}) {
    double whole = 0.0, cosine = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double c = -1.0 + 2.0 * (i + 0.5) / kSteps;
      const double part = phaseFunction(g, static_cast<float>(c)) * 2.0 * std::numbers::pi * 2.0 / kSteps;
      whole += part;
      cosine += part * c;
    }
    EXPECT_NEAR(whole, 1.0, 1e-5) << g;
    EXPECT_NEAR(cosine, g, 1e-5) << g;
  }
}

// The epipolar form is the model's, with another variable: what a metre scatters, by d s / d phi.
TEST(ScatteringIntegrand, IsTheScatteringOfAMetre) {
  const Medium medium{.sigmaS = vec3(0.1f, 0.2f, 0.05f), .sigmaA = vec3(0.0f, 0.1f, 0.2f), .g = 0.4f};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 20000; ++n) {
    const double D = 0.2 + 8.0 * unit(random), alpha = 0.05 + 3.0 * unit(random);
    const double phi = (std::numbers::pi - alpha) * (0.02 + 0.9 * unit(random));
    const double s = D * std::sin(phi) / std::sin(phi + alpha), r = D * std::sin(alpha) / std::sin(phi + alpha);
    // In the plane of L, E and the view ray: L at the origin, E at (0, D).
    const glm::dvec2 dir(std::sin(alpha), -std::cos(alpha));
    const glm::dvec2 point = glm::dvec2(0.0, D) + dir * s;
    ASSERT_NEAR(glm::length(point), r, 1e-9 * r);
    const vec3 metre =
        scatteredPerMetre(medium, vec3(point.x, point.y, 0), vec3(dir.x, dir.y, 0), static_cast<float>(s + r));
    const vec3 inPhi =
        scatteringIntegrand(medium, static_cast<float>(D), static_cast<float>(alpha), static_cast<float>(phi)) *
        scatteringFactor(medium, static_cast<float>(D), static_cast<float>(std::sin(alpha)));
    const double metresInPhi = r * r / (D * std::sin(alpha));
    // Rounding of phi + alpha where the angle at the point, pi - phi - alpha, is small.
    const double tolerance = 1e-5 + 2e-6 * (s + r) / (std::numbers::pi - phi - alpha);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(inPhi[c] / (metre[c] * metresInPhi), 1.0, tolerance) << D << " " << alpha << " " << phi;
    ASSERT_NEAR(phiOnViewRay(static_cast<float>(D), static_cast<float>(std::sin(alpha)),
                             static_cast<float>(std::cos(alpha)), static_cast<float>(s)),
                phi, 2e-6 * (1.0 + s / D));
  }
}

TEST(Cone, CutsViewRaysWhereTheirPointsEnterAndLeaveIt) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  size_t some = 0, none = 0, begins = 0;
  for (int n = 0; n < 5000; ++n) {
    std::normal_distribution<float> normal;
    const vec3 axis = unitVector(vec3(normal(random), normal(random), normal(random)));
    const float coneCos = unit(random), theta = 6.28f * unit(random), end = 3.1f * unit(random);
    const PhiRange range = phiWithinCone(axis, coneCos, vec2(std::sin(theta), std::cos(theta)), end);
    for (int i = 0; i < 64; ++i) {
      const float phi = end * (static_cast<float>(i) + 0.5f) / 64.0f;
      const float cosine = dot(epipolarDirection(theta, phi), axis);
      if (std::abs(cosine - coneCos) < 1e-5f) continue;  // within rounding of the cone
      ASSERT_EQ(phi >= range.begin && phi <= range.end, cosine > coneCos) << n << ", " << phi;
    }
    some += range.end > range.begin ? 1 : 0;
    none += range.end <= range.begin ? 1 : 0;
    begins += range.begin > 0.0f ? 1 : 0;
  }
  EXPECT_GT(some, 1000u);
  EXPECT_GT(none, 500u);
  EXPECT_GT(begins, 500u);
  const PhiRange all = phiWithinCone(vec3(0, 0, 1), -1.0f, vec2(0, 1), 2.5f);
  EXPECT_EQ(all.begin, 0.0f);
  EXPECT_EQ(all.end, 2.5f);
}

TEST(DensityBox, RaysAreCutWhereTheyEnterAndLeave) {
  DensityPlace place{
      .centerW = vec3(1, 2, 3), .centerI = vec3(10, 20, 30), .lowerI = vec3(5, 15, 28), .upperI = vec3(15, 25, 32)};
  place.indexFromWorld = mat3(vec3(0, 2, 0), vec3(-2, 0, 0), vec3(0, 0, 4));  // turned about z, and scaled
  std::mt19937 random(6);
  std::normal_distribution<float> normal;
  size_t met = 0;
  for (int n = 0; n < 4000; ++n) {
    const vec3 origin = place.centerW + vec3(normal(random), normal(random), normal(random)) * 4.0f;
    vec3 dir = unitVector(vec3(normal(random), normal(random), normal(random)));
    if (n % 8 == 0) dir = vec3(0, n % 16 == 0 ? 1 : -1, 0);
    const vec2 within = rayWithinBounds(place, origin, dir, 7.0f);
    met += within.x < within.y ? 1 : 0;
    for (int i = 0; i < 50; ++i) {
      const float s = 7.0f * (static_cast<float>(i) + 0.5f) / 50.0f;
      if (std::abs(s - within.x) < 1e-4f || std::abs(s - within.y) < 1e-4f) continue;
      const vec3 at = indexFromWorld(place, origin + dir * s);
      const bool inside = all(greaterThan(at, place.lowerI)) && all(lessThan(at, place.upperI));
      ASSERT_EQ(s > within.x && s < within.y, inside) << n;
    }
  }
  EXPECT_GT(met, 200u);
}

class MediumOnTheGpu : public gpu::GpuTest {};

// Bit for bit where there are but sums, products and roots; exp to 1.2e-5 of its value for each e-fold
// (docs/shared_glsl.md).
TEST_F(MediumOnTheGpu, IsThatOfTheCpu) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::normal_distribution<float> normal;
  std::vector<MediumQuery> queries(gpu::kKernelInputCount);
  for (MediumQuery& query : queries) {
    query.medium = {.sigmaS = vec3(unit(random), unit(random), unit(random)),
                    .sigmaA = vec3(unit(random)),
                    .g = 1.9f * unit(random) - 0.95f};
    query.fromLight = vec3(normal(random), normal(random), normal(random));
    query.dir = unitVector(vec3(normal(random), normal(random), normal(random)));
    query.eyeDistance = 3.0f * unit(random) + 0.1f;
    query.alpha = 3.1f * unit(random);
    query.phi = (kPi - query.alpha) * 0.9f * unit(random);
  }
  const auto answers =
      gpu::runKernel<MediumQuery, MediumAnswer>(device(), GNOMON_TEST_SHADER("evaluate_medium.comp.glsl"), queries);
  for (size_t n = 0; n < queries.size(); ++n) {
    const MediumAnswer cpu = mediumAnswer(queries[n]);
    const MediumAnswer& gpu = answers[n];
    ASSERT_LE(gpu::ulpDistance(gpu.phase, cpu.phase), 16 * exactTolerance());
    ASSERT_EQ(gpu.slice, cpu.slice);
    for (int c = 0; c < 3; ++c) {
      // A chain of quotients, which a driver may fold.
      ASSERT_LE(gpu::ulpDistance(gpu.perMetre[c], cpu.perMetre[c]), 512 * exactTolerance() + 2);
      ASSERT_NEAR(gpu.dimmed[c], cpu.dimmed[c], 3e-5f * cpu.dimmed[c]);
      // The path has the angle at the point in its denominator, where an ulp of pi is as much as 1e-6 of it.
      ASSERT_NEAR(gpu.integrand[c], cpu.integrand[c], 2e-4f * cpu.integrand[c] + 1e-7f) << n;
      ASSERT_NEAR(gpu.dirAgain[c], queries[n].dir[c], 1e-6f);
    }
    for (int c = 0; c < 2; ++c) ASSERT_LE(apart(gpu.uv[c], cpu.uv[c]), apartAtMost());
  }
}

}  // namespace
}  // namespace gnomon
