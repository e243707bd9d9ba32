// The gnomon program. Exit codes: 0 success, 1 runtime error, 2 usage error, 3 a --fail-if threshold was exceeded, or
// vsv --validate found a wrong voxel.

#include "base/check.h"
#include "base/error.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/results/schema.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace {

using namespace gnomon;

int parseAndRun(int argc, char** argv) {
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
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "gnomon: %s (see gnomon --help)\n", error.what());
    return 2;
  }
  const auto given = std::ranges::find_if(runs, [](const auto& run) { return run.first->parsed(); });
  GNOMON_CHECK(given != runs.end());  // require_subcommand saw to it
  return given->second();
}

}  // namespace

int main(int argc, char** argv) {
  setCommandLine(argc, argv);
  try {
    return parseAndRun(argc, argv);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "gnomon: %s\n", error.what());
    return 2;
  } catch (const WorldError& error) {
    std::fprintf(stderr, "gnomon: %s\n", error.what());
    return 1;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "gnomon: out of memory; take a smaller --size or --map-size, or a smaller scene\n");
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gnomon: %s\n", error.what());
    return 1;
  }
}
