#include "base/terminal.h"
#include "cli/choice.h"
#include "cli/completion.h"
#include "cli/offers.h"
#include "cli/verbs.h"
#include "lab/results/schema.h"

#include <memory>

#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

Run addCompletion(CLI::App* verb) {
  auto shell = std::make_shared<std::string>();
  offersOneOf(verb->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(oneOf(completionShells())),
              completionShells());
  verb->footer(
      "To try it: . <(gnomon completion bash). `cmake --install` puts the scripts where the shells look for them.");
  return [shell, verb] {
    say(completionScript(*verb->get_parent(), *shell));
    return 0;
  };
}

Run addManual(CLI::App* verb) {
  verb->footer("To read it: gnomon man | man -l -. `cmake --install` puts it where man looks for it.");
  return [verb] {
    say(manualPage(*verb->get_parent(), gnomonVersion()));
    return 0;
  };
}

}  // namespace

Verb completionVerb() {
  return {.name = "completion",
          .sentence = "writes a script by which a shell completes subcommands, flags and values",
          .add = addCompletion};
}

Verb manVerb() {
  return {.name = "man", .sentence = "writes the manual page, gnomon(1)", .add = addManual};
}

}  // namespace gnomon
