#include "lab/core/results_head.h"

#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

Json vectorJson(const glm::vec3& v) {
  return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)});
}

Json resultsHead(const Session& session, const SetupOptions& setup, const std::string& command, double gbufferMs) {
  const glsl::CameraView& view = session.view();
  Json json;
  json["schema"] = kResultsVersion;
  json["gnomon"] = {{"version", gnomonVersion()},
                    {"device", session.device().info().name},
                    {"driver", session.device().info().driver},
                    {"command", command}};
  json["scene"] = {{"name", session.scene().name},
                   {"source", setup.scene},
                   {"triangles", triangleCount(session.scene())},
                   {"sceneScale", shortest(computeBounds(session.scene()).diagonal())}};
  json["camera"] = {{"name", session.camera().name},
                    {"eye", vectorJson(view.eyeW)},
                    {"forward", vectorJson(view.forwardW)},
                    {"up", vectorJson(view.upW)},
                    {"fov_degrees", shortest(glm::degrees(session.camera().yFovRad))},
                    {"width", view.width},
                    {"height", view.height}};
  json["gbuffer_ms"] = gbufferMs;
  return json;
}

}  // namespace gnomon
