#pragma once
// What the results file of every verb begins with, and a light as it tells it.

#include "lab/core/session.h"
#include "lab/results/head.h"
#include "lab/results/light_facts.h"

namespace gnomon {

ResultsHead resultsHead(const Session& session, const std::string& command, double gbufferMs);

LightFacts lightFacts(const std::string& name, const LightModel& light);

}  // namespace gnomon
