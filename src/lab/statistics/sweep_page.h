#pragma once
// The page of a sweep: one file that works offline, with every answer and filters by scene, map and size.

#include "lab/statistics/answers.h"

#include <string>

namespace gnomon {

std::string sweepPage(const Answers& answers, const std::string& version);

}  // namespace gnomon
