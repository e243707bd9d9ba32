// Single scattering on the GPU against quadratures in double, and its ways of integrating against each other.
#include "media_fixture.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using test::MediaSetup;
using test::MediaWorld;

class MediaPassTest : public gpu::GpuTest {};

struct Place {
  const char* name;
  glm::vec3 eyeW, targetW;
  glm::dvec3 lightW;
};
constexpr int kPlaceCount = 6;
const Place kPlaces[kPlaceCount] = {
    {"light in the picture", {0, 1, 6}, {0.2f, 0.8f, 0}, {0.3, 1.2, 0.5}},
    {"light aside", {0, 1, 6}, {0, 1, 0}, {4.0, 2.5, 3.0}},
    {"light behind the camera", {0, 1, 6}, {0, 1, 0}, {0.4, 1.5, 9.0}},
    {"light straight behind the camera", {0, 1, 6}, {0, 1, 0}, {0.0, 1.0, 8.0}},
    {"camera close to the light", {0, 1, 6}, {0, 1, 0}, {0.05, 1.05, 5.98}},
    {"light far ahead", {0, 1, 6}, {0, 1, 0}, {0.5, 1.1, -30.0}},
};

TEST_F(MediaPassTest, WithNothingInTheWayItIsTheClosedForm) {
  for (const Place& place : kPlaces) {
    const MediaSetup setup = test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW);
    MediaWorld world(device(), setup);
    std::vector<glm::vec3> expected;
    for (size_t i = 0; i + 1 < world.endsW.size(); ++i)
      expected.emplace_back(
          test::unshadowedLight(setup.medium, setup.light, glm::dvec3(world.view.eyeW), world.endsW[i]));
    for (const MediaMethod& method :
         {MediaMethod{Integrator::Runs}, MediaMethod{Integrator::Bits}, MediaMethod{Integrator::Popcount},
          MediaMethod{Integrator::March, 512}}) {
      const std::vector<glm::vec3> measured = world.scattered(method);
      double worst = 0.0;
      for (size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(static_cast<double>(measured[i][c]) / expected[i][c] - 1.0));
      std::printf("%-34s %-9s worst %.3g, rel_rmse %.3g\n", place.name, integratorName(method.integrator),
                  worst, test::relativeRmse(measured, expected));
    }
  }
}

}  // namespace
}  // namespace gnomon
