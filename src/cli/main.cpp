// The gnomon program. Exit codes: kExitCodes.

#include "base/check.h"
#include "base/error.h"
#include "base/image.h"
#include "base/interrupt.h"
#include "base/message.h"
#include "base/suggest.h"
#include "base/terminal.h"
#include "cli/memory_limit.h"
#include "cli/output_flags.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "cli/version.h"
#include "lab/results/schema.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace {

using namespace gnomon;

constexpr const char* kExitCodes =
    "Exit codes: 0 success; 1 runtime error (file, device, memory); 2 usage error; 3 a --fail-if threshold was "
    "exceeded, or vsv --validate found a wrong voxel; 130 interrupted: what was done by then is written.";
constexpr const char* kEnvironment =
    "Environment: GNOMON_DEVICE is the same as --device; GNOMON_VALIDATION=1 enables the validation layers; "
    "GNOMON_CACHE_DIR is the folder of the shader cache (empty: no cache); COLUMNS is the width of tables.";

// No flag takes an empty value: a script's variable was not set.
void refuseEmptyWords(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word.empty()) throw UsageError(fmt::format("the word after '{}' is empty; give a value", argv[i - 1]));
    // "-o=out" is -o with the value "=out".
    if (word.size() > 2 && word[0] == '-' && word[1] != '-' && word[2] == '=')
      throw UsageError(
          fmt::format("{}: write {} {}", word, word.substr(0, 2), word.size() > 3 ? word.substr(3) : "VALUE"));
    if (word.starts_with("--") && word.ends_with('=')) throw UsageError(fmt::format("{} is empty; give a value", word));
  }
}

std::string verbNames() {
  std::string names;
  for (const Verb& verb : verbs()) names += (names.empty() ? "" : ", ") + std::string(verb.name);
  return names;
}

// The first word is a verb, or a flag of the program's own.
void checkVerb(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.starts_with("-")) return;
  if (word.empty()) throw UsageError("give a subcommand; choose from " + verbNames() + " (see gnomon --help)");
  if (std::ranges::none_of(verbs(), [&](const Verb& verb) { return verb.name == word; }))
    throw UsageError(fmt::format("{}: no such subcommand; {}", word, chooseFrom(word, verbNames())));
}

std::string wrongFirstWord(const std::string& word) {
  const std::string nearest = nearestName(word, {"--help", "--version"});
  return fmt::format("{}: no such flag{} (see gnomon --help)", word,
                     nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

// What is wrong with a command line that a verb does not understand. Of the words left over the first one is told.
std::string mistakeIn(const CLI::App& verb, const CLI::ParseError& error) {
  const std::vector<std::string> left = verb.remaining();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || left.empty())
    return fmt::format("{} (see gnomon {} --help)", error.what(), verb.get_name());
  const std::string word = left.front().substr(0, left.front().find('='));
  if (!word.starts_with("-")) return fmt::format("{}: one word too many (see gnomon {} --help)", word, verb.get_name());
  std::vector<std::string> flags;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  const std::string nearest = nearestName(word, flags);
  return fmt::format("{}: {} has no such flag{} (see gnomon {} --help)", word, verb.get_name(),
                     nearest.empty() ? "" : "; did you mean " + nearest + "?", verb.get_name());
}

int parseAndRun(int argc, char** argv) {
  refuseEmptyWords(argc, argv);
  CLI::App app("Gnomon measures shadow-map bias for point, spot and directional lights", "gnomon");
  app.set_version_flag("--version", versionText());
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default(false);
  const std::string ending = std::string(kExitCodes) + "\n" + kEnvironment;
  std::vector<std::pair<const CLI::App*, Run>> runs;
  for (const Verb& verb : verbs()) {
    CLI::App* added = app.add_subcommand(verb.name, verb.sentence);
    runs.emplace_back(added, verb.add(added));
    const std::string footer = added->get_footer();
    added->footer((footer.empty() ? "" : footer + "\n") + ending);
  }
  app.footer(ending);  // now: a subcommand begins with the program's
  checkVerb(argc, argv);
  const auto isGiven = [](const auto& run) { return run.first->parsed(); };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const auto given = std::ranges::find_if(runs, isGiven);
    if (error.get_exit_code() != 0)
      throw UsageError(given == runs.end() ? wrongFirstWord(argv[1]) : mistakeIn(*given->first, error));
    std::ostringstream help;  // --help, --version
    app.exit(error, help, help);
    say(help.str());
    return 0;
  }
  const auto given = std::ranges::find_if(runs, isGiven);
  GNOMON_CHECK(given != runs.end());  // require_subcommand saw to it
  refuseToWriteOverInputs(*given->first);
  return given->second();
}

// Whatever a library or a file put into a message: one line.
int complain(const char* message, int exitCode) {
  constexpr std::string_view kName = "gnomon: ";
  std::fprintf(stderr, "%s%s\n", kName.data(), oneLine(message, kLongestMessage - kName.size()).c_str());
  return exitCode;
}

int runAndComplain(int argc, char** argv) {
  try {
    const int exitCode = parseAndRun(argc, argv);
    finishStandardOutput();
    return exitCode;
  } catch (const UsageError& error) {
    return complain(printable(error.what()).c_str(), 2);  // ours: a newline is a name's
  } catch (const Interrupted&) {
    return complain("interrupted before there was anything to write", kInterruptedExitCode);
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
  setPictureOrigin(std::string("gnomon ") + gnomonVersion(), commandLine());
  const auto work = [&] { return runAndComplain(argc, argv); };
  return isMemoryLimited() ? runWithinMemoryLimit(work) : work();
}
