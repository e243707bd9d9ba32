#include "lab/results/media_row.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

std::string integratorText(const std::string& integrator, const std::optional<int>& steps) {
  return steps ? fmt::format("{} {}", integrator, *steps) : integrator;
}

const char* boundName(Bound bound) {
  return bound == Bound::AtLeast ? "at_least" : bound == Bound::AtMost ? "at_most" : "exact";
}

const char* errorMeasureName(ErrorMeasure measure) {
  return measure == ErrorMeasure::RelRmse ? "rel_rmse" : "rel_rmse_99";
}

const EqualTerms* findTerms(const std::vector<EqualTerms>& all, const std::string& method, bool withBuild,
                            ErrorMeasure measure) {
  const auto found = std::ranges::find_if(all, [&](const EqualTerms& terms) {
    return terms.method() == method && terms.withBuild == withBuild && terms.measure == measure;
  });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace gnomon
