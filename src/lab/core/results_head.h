#pragma once
// What the results file of every verb begins with.

#include "lab/core/session.h"
#include "lab/results/schema.h"

#include <nlohmann/json_fwd.hpp>

namespace gnomon {

// Schema, gnomon, scene, camera, gbuffer_ms.
nlohmann::ordered_json resultsHead(const Session& session, const SetupOptions& setup, const std::string& command,
                                   double gbufferMs);

nlohmann::ordered_json vectorJson(const glm::vec3& v);

}  // namespace gnomon
