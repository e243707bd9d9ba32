#pragma once
// The integrators: how the integral along a view ray is taken. To add one, write its shader and its row of the list.

#include <string>
#include <vector>

namespace gnomon {

struct Integrator {
  enum class Reads {
    Bits,    // of a shadow volume, and the table of the running integral
    Depths,  // of a shadow map
  };

  const char* name;
  const char* shader;  // in shaders/vsv
  Reads reads;
  bool takesSteps;       // samples at equal distances
  bool isBaseline;       // the others are compared with it
  bool standsInDensity;  // in a density all march: one stands for all that read the same
  const char* says;      // for --help
};

const std::vector<Integrator>& integrators();

// Throws UsageError that lists them.
const Integrator& findIntegrator(const std::string& name);

const Integrator& baselineIntegrator();

// What an integrator is in a heterogeneous medium.
const Integrator& integratorInDensity(const Integrator& integrator);

// "runs, bits, popcount, march"
std::string integratorNames();

struct MediaMethod {
  const Integrator* integrator = &integrators().front();
  int steps =
      0;  // where it takes any; and of every integrator in a heterogeneous medium, where the view ray is marched

  bool readsDepths() const { return integrator->reads == Integrator::Reads::Depths; }
  bool operator==(const MediaMethod&) const = default;
};
MediaMethod mediaMethod(const std::string& integrator, int steps = 0);

}  // namespace gnomon
