#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/terminal.h"
#include "cli/method_flags.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/compare/results.h"
#include "lab/compare/table.h"
#include "lab/compare/threshold.h"
#include "lab/page/report.h"
#include "lab/results/result_folder.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct CompareFlags {
  SceneFlags scene;
  MethodFlags method;
  std::string out;
  std::string json;
  std::vector<std::string> failIf;
  int repeats = 5;
  bool tune = false;
};

int runCompare(const CompareFlags& flags) {
  std::vector<Threshold> thresholds;
  for (const std::string& text : flags.failIf) thresholds.push_back(parseThreshold(text));
  CompareOptions options = compareOptions(flags.method);
  if (!flags.json.empty()) checkOutput(flags.json);
  ResultFolder folder(flags.out, "results.json");
  options.outDir = folder.aside();
  if (!flags.out.empty()) preloadImages();
  options.repeats = flags.repeats;
  options.tune = flags.tune;

  const Session session = openSession(flags.scene);
  Comparison comparison = compare(session, options);
  comparison.files = folder.files();
  const std::string json = resultsJson(session, comparison, commandLine());
  if (!flags.out.empty()) {
    writeTextFile(options.outDir / "results.json", json);
    writeTextFile(options.outDir / "report.html", reportHtml(options.outDir));
    folder.publish();
  }
  if (!flags.json.empty()) writeTextFile(flags.json, json);

  say(comparisonHeader(session, comparison));
  say(comparisonTable(comparison));
  say(tuningTable(comparison));
  if (!flags.out.empty()) say(fmt::format("wrote {0}/report.html, results.json and pictures below {0}\n", flags.out));
  for (const Threshold& threshold : thresholds) {
    if (const std::optional<std::string> line = crossed(threshold, comparison.rows)) {
      std::fprintf(stderr, "gnomon: %s\n", line->c_str());
      return 3;
    }
  }
  return 0;
}

Run addCompare(CLI::App* verb) {
  auto flags = std::make_shared<CompareFlags>();
  addSceneFlags(*verb, flags->scene);
  addMethodFlags(*verb, flags->method, "spot", "all");
  verb->add_option("-o,--out", flags->out,
                   "folder for report.html, pictures and results.json; default: only the table is printed");
  verb->add_option("--json", flags->json, "write results.json here");
  verb->add_option("--fail-if", flags->failIf,
                   "exit with 3 if exceeded: [[map/]bias:]metric>limit[%], as in 'acne>0.1%'; metrics are " +
                       thresholdMetrics() + "; may be repeated");
  verb->add_flag("--tune", flags->tune,
                 "also run each bias at the parameter values with the least acne + leak, and test those values from "
                 "another camera and at half the map size");
  verb->add_option("--repeats", flags->repeats, "repetitions of every timed stage; medians are reported")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  return [flags] { return runCompare(*flags); };
}

}  // namespace

Verb compareVerb() {
  return {
      .name = "compare",
      .sentence = "compares every chosen map x bias with the exact shadow: table, pictures, results.json, report.html",
      .add = addCompare};
}

}  // namespace gnomon
