#include "base/error.h"
#include "base/file.h"
#include "base/terminal.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/verbs.h"
#include "cli/wrap.h"
#include "lab/page/report.h"
#include "lab/results/schema.h"
#include "lab/statistics/answers_text.h"
#include "lab/statistics/sweep_page.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct ReportFlags {
  std::string source;  // a folder, or a store
  std::string out;
  std::string csv, latex, json, markdown, by;
  CaseFilter filter;

  bool isForStores() const {
    return !csv.empty() || !latex.empty() || !json.empty() || !markdown.empty() || !by.empty() ||
           !filter.scenes.empty() || !filter.maps.empty() || !filter.sizes.empty();
  }
};

void checkPageName(const std::string& out) {
  const std::string extension = std::filesystem::path(out).extension().string();
  if (!out.empty() && extension != ".html" && extension != ".htm" && !isStream(out))
    throw UsageError(fmt::format("-o {}: the name must end in .html", out));
}

int runFolderReport(const ReportFlags& flags) {
  if (flags.isForStores())
    throw UsageError(
        fmt::format("{}: is no store of gnomon sweep, which --csv, --latex, --json, --markdown, --by, "
                    "--scene, --map and --map-size are for",
                    flags.source));
  if (flags.out.empty()) throw UsageError("give -o FILE.html");
  writeTextFile(flags.out, reportHtml(flags.source));
  say(fmt::format("wrote {}\n", flags.out));
  return 0;
}

int runStoreReport(ReportFlags flags) {
  struct Output {
    const std::string& path;
    std::function<std::string(const Answers&)> text;
  };
  const Output outputs[] = {{flags.out, [](const Answers& answers) { return sweepPage(answers, gnomonVersion()); }},
                            {flags.csv, answersCsv},
                            {flags.latex, answersLatex},
                            {flags.json, answersJson},
                            {flags.markdown, answersMarkdown}};
  if (!flags.by.empty()) flags.filter.by = parseErrorBy(flags.by);
  const Answers answers = answersOf(Store(flags.source, sql::Open::ReadOnly), flags.filter);
  bool wrote = false;
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    writeTextFile(output.path, output.text(answers));
    wrote = true;
    if (output.path != "-") say(fmt::format("wrote {}\n", output.path));
  }
  if (!wrote) say(rankingText(answers, terminalWidth()) + howIntervals(answers) + "\n");
  return 0;
}

int runReport(const ReportFlags& flags) {
  checkPageName(flags.out);
  for (const std::string& file : {flags.out, flags.csv, flags.latex, flags.json, flags.markdown})
    if (!file.empty()) checkOutput(file);
  constexpr const char* kRemedy =
      "name a folder that gnomon compare -o or gnomon fog -o wrote, or a store of gnomon sweep";
  const std::filesystem::path source = flags.source;
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(source, failure);
  if (std::filesystem::is_directory(status)) return runFolderReport(flags);
  if (!std::filesystem::exists(status)) {
    const bool isAbsent = status.type() == std::filesystem::file_type::not_found;
    throw fileError(flags.source, isAbsent ? "does not exist" : failure.message(), kRemedy);
  }
  if (!std::filesystem::is_regular_file(status))
    throw fileError(flags.source, "is a device or a pipe, and no file", kRemedy);
  if (source.extension() == ".json") throw fileError(flags.source, "is no store", "name its folder");
  return runStoreReport(flags);
}

Run addReport(CLI::App* verb) {
  auto flags = std::make_shared<ReportFlags>();
  offersFiles(verb->add_option("DIR", flags->source,
                               "a folder written by gnomon compare -o or gnomon fog -o; or a store of gnomon sweep")
                  ->required());
  offersFiles(verb->add_option("-o,--out", flags->out,
                               "the page: FILE.html; of a store, without any file, the ranking is printed"));
  const OptionGroup group(*verb, "Of a store");
  offersFiles(verb->add_option("--csv", flags->csv, "statistics, a line a method and subset; - is standard output"));
  offersFiles(verb->add_option("--latex", flags->latex, "tables for booktabs"));
  offersFiles(verb->add_option("--json", flags->json, "all answers"));
  offersFiles(verb->add_option("--markdown", flags->markdown, "the tables of docs/findings.md"));
  verb->add_option("--scene", flags->filter.scenes, "only of this scene; may be repeated")->allow_extra_args(false);
  verb->add_option("--map", flags->filter.maps, "only of this map; may be repeated")->allow_extra_args(false);
  verb->add_option("--map-size", flags->filter.sizes, "only of maps with this side, texels; may be repeated")
      ->allow_extra_args(false);
  offersOneOf(
      verb->add_option("--by", flags->by,
                       "bias_error, all_wrong or rmse: what ranks; default: the bias error, and through filters "
                       "the RMSE"),
      {"bias_error", "all_wrong", "rmse"});
  return [flags] { return runReport(*flags); };
}

}  // namespace

Verb reportVerb() {
  return {
      .name = "report",
      .sentence = "rebuilds the HTML report of a folder that compare or fog wrote; or shows what a sweep's store says",
      .add = addReport};
}

}  // namespace gnomon
