#pragma once
// Where light and camera stand when nobody says: outside, looking at the scene, unless the scene is a room.

#include "truth/tracer.h"

namespace gnomon {

// One of a handful of places, the first from which the camera sees something that `light` lights; the first of all
// where none does.
Camera defaultCamera(const Tracer& tracer, const Light& light);

// Above the scene, or below a room's roof.
Light defaultLight(const Tracer& tracer);

// A hundredth of a percent of the scene's diagonal: for cameras that no file places.
float defaultNearPlane(const Bounds& boundsW);

}  // namespace gnomon
