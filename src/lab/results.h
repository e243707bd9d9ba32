#pragma once
// results.json, the schema that docs/results.md describes and a test holds.

#include "lab/compare.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gnomon {

inline constexpr int kResultsVersion = 3;

const char* gnomonVersion();

// What the file of every verb begins with: schema, gnomon, scene, camera, gbuffer_ms.
nlohmann::ordered_json resultsHead(const Session& session, const SetupOptions& setup,
                                   const std::string& command, double gbufferMs);

// Digits of a float: 0.1f as 0.1, not as 0.10000000149.
double shortest(float value);
nlohmann::ordered_json vectorJson(const glm::vec3& v);

// The whole file as text. `command` is the line that makes it again.
std::string resultsJson(const Session& session, const SetupOptions& setup, const Comparison& comparison,
                        const std::string& command);

}  // namespace gnomon
