#pragma once
// A light as results.json describes it.

#include "lab/results/schema.h"

#include <glm/glm.hpp>

namespace gnomon {

struct LightFacts {
  std::string name, type;
  std::optional<glm::vec3> position, intensity, direction;
  std::optional<float> coneDegrees;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &LightFacts::name, {.says = "name of the light"}),
        field("type", &LightFacts::type, {.says = "point, spot, directional"}),
        field("position", &LightFacts::position,
              {.unit = "metres", .says = "absent for a directional light", .absent = Absent::LeftOut}),
        field("intensity", &LightFacts::intensity,
              {.unit = "candela", .says = "rgb; only in `lights` of gnomon fog", .absent = Absent::LeftOut}),
        field("direction", &LightFacts::direction,
              {.says = "unit vector of its axis or rays; absent for a point light", .absent = Absent::LeftOut}),
        field("cone_degrees", &LightFacts::coneDegrees,
              {.unit = "degrees", .says = "full angle of a spot light's cone", .absent = Absent::LeftOut}));
  }
};

}  // namespace gnomon
