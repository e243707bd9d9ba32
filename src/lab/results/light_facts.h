#pragma once
// A light as results.json tells it.

#include "lab/results/schema.h"

#include <glm/glm.hpp>

namespace gnomon {

struct LightFacts {
  std::string name, type;
  std::optional<glm::vec3> position, intensity, direction;
  std::optional<float> coneDegrees;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &LightFacts::name, {.says = "as the scene calls it"}),
        field("type", &LightFacts::type, {.says = "point, spot, directional"}),
        field("position", &LightFacts::position,
              {.unit = "metres", .says = "not of a directional light", .absent = Absent::LeftOut}),
        field("intensity", &LightFacts::intensity,
              {.unit = "candela", .says = "rgb; of a medium alone", .absent = Absent::LeftOut}),
        field("direction", &LightFacts::direction,
              {.says = "unit vector, the way it shines; not of a point light", .absent = Absent::LeftOut}),
        field("cone_degrees", &LightFacts::coneDegrees,
              {.unit = "degrees", .says = "the whole cone of a spot light", .absent = Absent::LeftOut}));
  }
};

}  // namespace gnomon
