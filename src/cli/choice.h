#pragma once
// A flag's value that must be one of a list: --help shows the list as {a,b}, a misspelt value is answered with the
// nearest one.

#include "base/suggest.h"

#include <algorithm>
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

}  // namespace gnomon
