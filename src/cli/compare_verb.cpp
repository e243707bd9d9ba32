#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/interrupt.h"
#include "base/parse.h"
#include "base/terminal.h"
#include "cli/method_flags.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/output_flags.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/unused_flags.h"
#include "cli/verbs.h"
#include "cli/wrap.h"
#include "lab/compare/equal_error.h"
#include "lab/compare/recommendation.h"
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

namespace fs = std::filesystem;

struct CompareFlags {
  SceneFlags scene;
  MethodFlags method;
  std::string out;
  std::string json;
  std::vector<std::string> failIf;
  int repeats = 5;
  bool tune = false;
  bool wide = false;
  std::string untilError;
  int untilMapSize = CompareOptions().untilMapSide;
};

// "0.1%" or "0.001".
double parseShare(const std::string& flag, const std::string& text) {
  const bool percent = text.ends_with('%');
  const std::optional<double> number = parseNumber(percent ? text.substr(0, text.size() - 1) : text);
  const double share = number.value_or(-1.0) * (percent ? 0.01 : 1.0);
  if (!(share > 0.0 && share < 1.0))
    throw UsageError(
        fmt::format("{} {}: write a share of the pixels between 0 and 1, as in 0.1% or 0.001", flag, text));
  return share;
}

int runCompare(const CompareFlags& flags) {
  std::vector<Threshold> thresholds;
  for (const std::string& text : flags.failIf) thresholds.push_back(parseThreshold(text));
  CompareOptions options = compareOptions(flags.method);
  // Of the map's name only where one is given: else it is that of the light, which is read below.
  if (!flags.method.map.maps.empty())
    for (const Threshold& threshold : thresholds) checkMeansARow(threshold, options);
  checkFolderName(
      flags.out,
      "name a folder without such an ending (--json FILE writes the numbers alone, gnomon render one picture)");
  if (!flags.json.empty()) checkOutput(flags.json);
  const InterruptGuard guard;  // before there is a folder that must not stay
  ResultFolder folder(flags.out, "results.json");
  options.outDir = folder.aside();
  if (!flags.out.empty()) preloadImages();
  options.repeats = flags.repeats;
  options.tune = flags.tune;
  options.recommend = true;
  if (!flags.untilError.empty()) options.untilError = parseShare("--until-error", flags.untilError);
  options.untilMapSide = flags.untilMapSize;

  const Session session = openSession(flags.scene);
  chooseUsualMap(flags.method, session, options);
  const UnusedFlags unused(*flags.method.verb);
  unused.tellUnless(!flags.untilError.empty(), "--until-map-size", "it is of --until-error");
  unused.tellUnless(!flags.out.empty(), "--exposure", "it is of the pictures, which -o writes");
  for (const Threshold& threshold : thresholds) checkMeansARow(threshold, options);
  options.soFar = [&](const Comparison& soFar) {
    if (!flags.out.empty()) writeTextFile(options.outDir / "results.json", resultsJson(session, soFar, commandLine()));
    if (!flags.json.empty() && !isStream(flags.json))
      writeTextFile(flags.json, resultsJson(session, soFar, commandLine()));
  };
  Comparison comparison = compare(session, options);
  if (!flags.out.empty()) fs::remove(options.outDir / "results.json");  // it is none of its files
  comparison.files = folder.files();
  const std::string json = resultsJson(session, comparison, commandLine());
  if (!flags.out.empty()) {
    writeTextFile(options.outDir / "results.json", json);
    writeTextFile(options.outDir / "report.html", reportHtml(options.outDir));
    folder.publish();
  }
  if (!flags.json.empty()) writeTextFile(flags.json, json);

  const size_t width = terminalWidth();
  say(wrapped(comparisonHeader(session, comparison), width));
  say(comparisonTable(comparison, {.wide = flags.wide, .width = width}));
  say(wrapped(tuningTable(comparison) + equalErrorTable(comparison) + recommendation(comparison), width));
  if (!flags.out.empty()) say(fmt::format("wrote {0}/report.html, results.json and pictures below {0}\n", flags.out));
  if (!comparison.isComplete) {
    std::fprintf(stderr, "gnomon: interrupted: %zu rows are done\n", comparison.rows.size());
    return kInterruptedExitCode;
  }
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
  addMethodFlags(*verb, flags->method, "all", "comma-separated", "comma-separated, or all");
  addExposureFlag(*verb, flags->method.map.exposure);
  verb->get_option("--exposure")->group("View and device");
  const OptionGroup group(*verb, "Measurement and output");
  offersFolders(verb->add_option(
      "-o,--out", flags->out, "folder for report.html, pictures and results.json; default: only the table is printed"));
  offersFiles(verb->add_option("--json", flags->json,
                               "write results.json here; after each map and light what there is by then"));
  verb->add_option("--fail-if", flags->failIf,
                   "exit with 3 if exceeded: [[map/]bias:]metric>limit[%], as in 'acne>0.1%'; metrics are " +
                       thresholdMetrics() + "; may be repeated");
  verb->add_flag("--tune", flags->tune,
                 "also run each bias at the parameter values with the least acne + leak, and test those values from "
                 "another camera and at half the map size");
  verb->add_option("--until-error", flags->untilError,
                   "also find each method's smallest map at which at most this share of all pixels is wrong, edges "
                   "included, and what that costs: 0.1% or 0.001");
  verb->add_option("--until-map-size", flags->untilMapSize, "side of the largest map that --until-error tries, texels")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  verb->add_flag("--wide", flags->wide,
                 "all columns in the table; default: the main ones, and only as many as the terminal has room for");
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
