#include "lab/core/results_head.h"

namespace gnomon {

namespace {

const char* lightTypeName(LightType type) {
  switch (type) {
    case LightType::Point:
      return "point";
    case LightType::Spot:
      return "spot";
    case LightType::Directional:
      return "directional";
  }
  return "";
}

}  // namespace

ResultsHead resultsHead(const Session& session, const std::string& command, double gbufferMs) {
  const glsl::CameraView& view = session.view();
  ResultsHead head;
  head.program = {.version = gnomonVersion(),
                  .device = session.device().info().name,
                  .driver = session.device().info().driver,
                  .command = command};
  head.scene = {.name = session.scene().name,
                .source = session.setup().scene,
                .triangles = triangleCount(session.scene()),
                .sceneScale = computeBounds(session.scene()).diagonal(),
                .origin = glm::vec3(session.scene().originW)};  // a small multiple of a power of two: exact
  head.camera = {.name = session.camera().name,
                 .eye = view.eyeW,
                 .forward = view.forwardW,
                 .up = view.upW,
                 .fovDegrees = glm::degrees(session.camera().yFovRad),
                 .width = view.width,
                 .height = view.height};
  head.gbufferMs = gbufferMs;
  return head;
}

LightFacts lightFacts(const std::string& name, const LightModel& light) {
  LightFacts facts{.name = name, .type = lightTypeName(light.type)};
  if (light.type != LightType::Directional) facts.position = glm::vec3(light.positionW);
  if (light.type != LightType::Point) facts.direction = glm::vec3(light.directionW);
  if (light.type == LightType::Spot) facts.coneDegrees = static_cast<float>(2.0 * glm::degrees(light.outerConeRad));
  return facts;
}

}  // namespace gnomon
