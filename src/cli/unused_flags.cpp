#include "cli/unused_flags.h"

#include "base/error.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

bool UnusedFlags::isGiven(const std::string& flag) const {
  const CLI::Option* option = verb_.get_option_no_throw(flag);
  return option != nullptr && option->count() > 0;
}

void UnusedFlags::tellUnless(bool isUsed, const std::string& flag, const std::string& why) const {
  if (!isUsed && isGiven(flag)) fmt::print(stderr, "gnomon: note: {} has no effect: {}\n", flag, why);
}

void UnusedFlags::refuseUnless(bool isUsed, const std::string& flag, const std::string& why) const {
  if (!isUsed && isGiven(flag)) throw UsageError(fmt::format("{} has no effect: {}", flag, why));
}

}  // namespace gnomon
