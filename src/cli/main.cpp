// The gnomon program. Exit codes: 0 success, 1 runtime error, 2 usage error, 3 a --fail-if threshold was exceeded, or
// vsv --validate found a wrong voxel.

#include "base/check.h"
#include "base/error.h"
#include "base/message.h"
#include "base/terminal.h"
#include "cli/memory_limit.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/results/schema.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace {

using namespace gnomon;

// No flag takes an empty value: a script's variable was not set.
void refuseEmptyWords(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word.empty()) throw UsageError(fmt::format("the word after '{}' is empty; give a value", argv[i - 1]));
    if (word.starts_with("--") && word.ends_with('=')) throw UsageError(fmt::format("{} is empty; give a value", word));
  }
}

int parseAndRun(int argc, char** argv) {
  refuseEmptyWords(argc, argv);
  CLI::App app("Gnomon measures shadow-map bias for point, spot and directional lights", "gnomon");
  app.set_version_flag("--version", gnomonVersion());
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 success; 1 runtime error (file, device, memory); 2 usage error; 3 a --fail-if threshold was "
      "exceeded, or vsv --validate found a wrong voxel.\n"
      "Environment: GNOMON_DEVICE is the same as --device; GNOMON_VALIDATION=1 enables the validation layers; "
      "GNOMON_CACHE_DIR is the folder of the shader cache (empty: no cache).");
  app.option_defaults()->always_capture_default(false);
  std::vector<std::pair<const CLI::App*, Run>> runs;
  for (const Verb& verb : verbs()) {
    CLI::App* added = app.add_subcommand(verb.name, verb.sentence);
    runs.emplace_back(added, verb.add(added));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw UsageError(fmt::format("{} (see gnomon --help)", error.what()));
    std::ostringstream help;  // --help, --version
    app.exit(error, help, help);
    say(help.str());
    return 0;
  }
  const auto given = std::ranges::find_if(runs, [](const auto& run) { return run.first->parsed(); });
  GNOMON_CHECK(given != runs.end());  // require_subcommand saw to it
  return given->second();
}

// Whatever a library or a file put into a message: one line.
int complain(const char* message, int exitCode) {
  std::fprintf(stderr, "gnomon: %s\n", oneLine(message).c_str());
  return exitCode;
}

int runAndComplain(int argc, char** argv) {
  try {
    const int exitCode = parseAndRun(argc, argv);
    finishStandardOutput();
    return exitCode;
  } catch (const UsageError& error) {
    return complain(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return complain("out of memory; take a smaller --size or --map-size, or a smaller scene", 1);
  } catch (const std::exception& error) {
    return complain(error.what(), 1);
  }
}

}  // namespace

int main(int argc, char** argv) {
  guardStandardStreams();
  setCommandLine(argc, argv);
  const auto work = [&] { return runAndComplain(argc, argv); };
  return isMemoryLimited() ? runWithinMemoryLimit(work) : work();
}
