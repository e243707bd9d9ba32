#pragma once
// Fills in the beginning of every verb's results.json, and its description of a light.

#include "lab/core/session.h"
#include "lab/results/head.h"
#include "lab/results/light_facts.h"

namespace gnomon {

ResultsHead resultsHead(const Session& session, const std::string& command, double gbufferMs);

LightFacts lightFacts(const std::string& name, const LightModel& light);

}  // namespace gnomon
