#include "cli/unused_flags.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

void UnusedFlags::tellUnless(bool isUsed, const std::string& flag, const std::string& why) const {
  if (isUsed) return;
  const CLI::Option* option = verb_.get_option_no_throw(flag);
  if (option != nullptr && option->count() > 0) fmt::print(stderr, "gnomon: note: {} has no effect: {}\n", flag, why);
}

}  // namespace gnomon
