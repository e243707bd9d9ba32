#pragma once
// results.json of a comparison (docs/results.md).

#include "lab/compare/compare.h"

#include <string>

namespace gnomon {

// The whole file as text. `command` is the line that makes it again.
std::string resultsJson(const Session& session, const Comparison& comparison, const std::string& command);

}  // namespace gnomon
