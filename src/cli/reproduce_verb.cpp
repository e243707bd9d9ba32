#include "base/error.h"
#include "base/file.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/terminal.h"
#include "cli/offers.h"
#include "cli/output_flags.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/paper/reproduce.h"
#include "lab/results/result_folder.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct ReproduceFlags {
  ReproduceOptions options;
  std::string out;
  std::string device;
};

int runReproduce(const ReproduceFlags& flags) {
  ReproduceOptions options = flags.options;
  checkFolderName(flags.out, "name a folder without such an ending");
  const InterruptGuard guard;  // before there is a folder that must not stay
  ResultFolder folder(flags.out, "results.json");
  options.outDir = folder.aside();
  const Reproduction reproduction = reproduce({.name = flags.device}, options);
  if (!flags.out.empty()) {
    writeTextFile(options.outDir / "results.json", reproductionJson(reproduction, options, commandLine()));
    writeTextFile(options.outDir / "report.html", reproductionHtml(reproduction, options, commandLine()));
    folder.publish();
  }
  say(reproductionText(reproduction));
  if (!flags.out.empty()) say(fmt::format("wrote {0}/report.html, results.json and pictures below {0}\n", flags.out));
  return 0;
}

Run addReproduce(CLI::App* verb) {
  auto flags = std::make_shared<ReproduceFlags>();
  std::string papers;
  for (const std::string& paper : reproduciblePapers()) papers += (papers.empty() ? "" : " or ") + paper;
  offersOneOf(verb->add_option("PAPER", flags->options.paper, papers)->required(), reproduciblePapers());
  offersFolders(
      verb->add_option("-o,--out", flags->out,
                       "folder for report.html, pictures and results.json; default: only the verdicts are printed"));
  offersFiles(verb->add_option("--scene", flags->options.scene,
                               "use this glTF file or generated scene, with its first camera and the first light that "
                               "each map supports; default: a scene for each figure"),
              sceneNames());
  verb->add_option("--scale", flags->options.scale,
                   "scale factor for the sides of pictures, maps and volumes, for a quick look: 0.05..1; the "
                   "verdicts are meant for 1")
      ->capture_default_str();
  verb->add_option("--repeats", flags->options.repeats, "repetitions of every timed frame; medians are reported")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--device", flags->device,
                   "part of a Vulkan device's name; default: a GPU if there is one, else the CPU device (lavapipe)");
  verb->add_flag_callback(
      "--quiet", [] { Progress::setQuiet(true); }, "no progress display");
  return [flags] { return runReproduce(*flags); };
}

}  // namespace

Verb reproduceVerb() {
  return {.name = "reproduce",
          .sentence = "reproduces a paper's figures and tables, and tests whether its claims hold here",
          .add = addReproduce};
}

}  // namespace gnomon
