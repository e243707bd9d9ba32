#pragma once
// A flag's value that must be one of a list: --help shows the list as {a,b}, a misspelt value is answered with the
// nearest one. Or a number of a range.

#include "base/parse.h"
#include "base/suggest.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

namespace gnomon {

inline CLI::Validator oneOf(const std::vector<std::string>& names) {
  return {[names](const std::string& value) {
            if (std::ranges::find(names, value) != names.end()) return std::string();
            return fmt::format("{}: no such choice; {}", value,
                               chooseFrom(value, fmt::format("{}", fmt::join(names, ", "))));
          },
          fmt::format("{{{}}}", fmt::join(names, ","))};
}

// As CLI::Range, in which every nan is.
inline CLI::Validator within(double lower, double upper) {
  return {[lower, upper](const std::string& text) {
            const std::optional<double> value = parseNumber(text);
            if (value && *value >= lower && *value <= upper) return std::string();
            return fmt::format("Value {} not in range [{} - {}]", text, lower, upper);
          },
          fmt::format("FLOAT in [{} - {}]", lower, upper)};
}

}  // namespace gnomon
