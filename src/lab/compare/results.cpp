#include "lab/compare/results.h"

#include "lab/core/results_head.h"
#include "lab/results/results_file.h"

namespace gnomon {

std::string resultsJson(const Session& session, const Comparison& comparison, const std::string& command) {
  Comparison whole = comparison;
  static_cast<ResultsHead&>(whole) = resultsHead(session, command, comparison.gbufferMs);
  whole.files = comparison.files;
  whole.isComplete = comparison.isComplete;
  return resultsText(whole);
}

}  // namespace gnomon
