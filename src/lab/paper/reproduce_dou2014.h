#pragma once
// The parts of the reproduction of Dou et al. 2014 that are in separate files.

#include "lab/paper/paper_run.h"

namespace gnomon {

// What the paper prints and does not mean, or leaves open: a line each with the count of wrong pixels, and
// numbers such as "wrong(equation 6, as printed)".
void runErrata(PaperRun& run);

// Table 1 and figure 10: what frames cost, in rounds.
void runDouTimes(PaperRun& run);

std::vector<Claim> douClaims();

}  // namespace gnomon
