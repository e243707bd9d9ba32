#include "vsv/media/integrator.h"

#include "base/check.h"
#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

const std::vector<Integrator>& integrators() {
  using enum Integrator::Reads;
  static const std::vector<Integrator> kIntegrators = {
      {.name = "runs",
       .shader = "vsv/integrate_runs.comp.glsl",
       .reads = Bits,
       .says = "sums differences of the running integral over runs of lit bits in a shadow volume"},
      {.name = "bits",
       .shader = "vsv/integrate_bits.comp.glsl",
       .reads = Bits,
       .standsInDensity = true,
       .says = "sums the integral over each lit bit"},
      {.name = "popcount",
       .shader = "vsv/integrate_popcount.comp.glsl",
       .reads = Bits,
       .says = "multiplies the whole integral by the fraction of lit bits"},
      {.name = "march",
       .shader = "vsv/march_map.comp.glsl",
       .reads = Depths,
       .takesSteps = true,
       .isBaseline = true,
       .standsInDensity = true,
       .says = "takes --steps samples at equal distances, each looked up in a shadow map (--march-map)"},
  };
  return kIntegrators;
}

const Integrator& findIntegrator(const std::string& name) {
  const auto found = std::ranges::find_if(integrators(), [&](const Integrator& i) { return i.name == name; });
  if (found == integrators().end())
    throw UsageError(fmt::format("--integrators {}: {}", name, chooseFrom(name, integratorNames())));
  return *found;
}

const Integrator& baselineIntegrator() {
  const auto found = std::ranges::find_if(integrators(), &Integrator::isBaseline);
  GNOMON_CHECK(found != integrators().end());
  return *found;
}

const Integrator& integratorInDensity(const Integrator& integrator) {
  const auto found = std::ranges::find_if(
      integrators(), [&](const Integrator& i) { return i.standsInDensity && i.reads == integrator.reads; });
  GNOMON_CHECK(found != integrators().end());
  return *found;
}

std::string integratorNames() {
  std::string names;
  for (const Integrator& integrator : integrators())
    names += (names.empty() ? "" : ", ") + std::string(integrator.name);
  return names;
}

MediaMethod mediaMethod(const std::string& integrator, int steps) {
  return {.integrator = &findIntegrator(integrator), .steps = steps};
}

}  // namespace gnomon
