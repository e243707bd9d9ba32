#pragma once
// results.json, the schema that docs/results.md describes and a test holds.

#include "lab/compare/compare.h"

#include <string>

namespace gnomon {

// The whole file as text. `command` is the line that makes it again.
std::string resultsJson(const Session& session, const SetupOptions& setup, const Comparison& comparison,
                        const std::string& command);

}  // namespace gnomon
