#include "lab/compare/results.h"

#include "lab/core/results_head.h"
#include "lab/results/results_file.h"

namespace gnomon {

std::string resultsJson(const Session& session, const Comparison& comparison, const std::string& command) {
  Comparison whole = comparison;
  static_cast<ResultsHead&>(whole) = resultsHead(session, command, comparison.gbufferMs);
  whole.files = comparison.files;
  return resultsText(whole);
}

}  // namespace gnomon
