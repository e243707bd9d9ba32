#include "vsv/media/media_receivers.h"

#include <algorithm>

namespace gnomon {

std::vector<glm::dvec3> mediaReceiversW(const glsl::CameraView& camera, const Receivers& receivers, double reach) {
  const glm::dvec3 eyeW(camera.eyeW);
  std::vector<glm::dvec3> ends(receivers.states.size() + 1, eyeW);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    const int x = static_cast<int>(i) % receivers.width, y = static_cast<int>(i) / receivers.width;
    const glm::dvec3 dir = glm::normalize(glm::dvec3(glsl::pixelDirection(camera, x, y)));
    double end = reach;
    if (receivers.states[i] != PixelState::Empty)
      end = std::min(end, glm::dot(receivers.samples[i].positionW - eyeW, dir));
    ends[i] = eyeW + dir * end;
  }
  return ends;
}

}  // namespace gnomon
