#pragma once
// Cameras and lights at random places of a scene where there is something to see: the same seed gives the same ones.

#include "lab/core/setup.h"

#include <string>
#include <vector>

namespace gnomon {

// As --camera takes them: eyes in the scene's air, each with a surface in the middle of its picture that one of the
// lights lights (in turn), and light on at least a tenth of what it sees. Fewer than `count` where a hundred thousand
// tries find no more.
std::vector<std::string> randomCameras(const SetupOptions& setup, const Tracer& tracer,
                                       const std::vector<Light>& lights, int count, uint64_t seed);

// As --light takes them: points in the air, from which a quarter of all directions meet surfaces that face them.
std::vector<std::string> randomLights(const Tracer& tracer, int count, uint64_t seed);

}  // namespace gnomon
