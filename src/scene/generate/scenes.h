#pragma once
// One function for each generated scene; the table in generate.cpp says what each provokes.

#include "scene/scene.h"

namespace gnomon {

Scene makeLshape();
Scene makeDoubleTorus();
Scene makeFactory();
Scene makeAtrium();
Scene makeCorner();
Scene makeGrate();
Scene makeSheets();
Scene makeContact();
Scene makeTiltedPlanes();
Scene makeNearFar();

// Within 5% of `triangles`, which must be in this range.
constexpr uint64_t kCrowdMin = 10'000;
constexpr uint64_t kCrowdMax = 19'000'000;
constexpr uint64_t kCrowdDefault = 100'000;
Scene makeCrowd(uint64_t triangles);

}  // namespace gnomon
