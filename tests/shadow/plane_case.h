#pragma once
// A receiver on a plane at some angle to the light, and what a map would hold of that very plane in the receiver's
// texel.

#include "map_fixture.h"

#include "shared/bias.glsl"

namespace gnomon::test {

struct PlaneCase {
  glsl::Receiver receiver;
  glsl::Tap tap;
  bool meets = false;  // the texel's ray meets the plane between near and far
};

// The plane through the sample whose normal, which faces the light, has tan `tanAngle` to the sample's ray.
PlaneCase planeCase(const glsl::ShadowMap& map, const MapSample& sample, float tanAngle, float azimuth);

}  // namespace gnomon::test
