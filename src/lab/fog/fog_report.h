#pragma once
// The results of `gnomon fog`, as a table for the terminal and as results.json (docs/results.md).

#include "lab/fog/fog.h"

#include <string>

namespace gnomon {

// Scene, lights, medium, reference; the rows; what is faster or better than a march, and by how much.
std::string fogTable(const Session& session, const FogOptions& options, const FogResult& result);

std::string fogJson(const Session& session, const FogOptions& options, const FogResult& result,
                    const std::string& command);

}  // namespace gnomon
