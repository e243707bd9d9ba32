#include "base/error.h"
#include "base/file.h"
#include "base/terminal.h"
#include "cli/offers.h"
#include "cli/verbs.h"
#include "lab/page/report.h"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct ReportFlags {
  std::string folder;
  std::string out;
};

int runReport(const ReportFlags& flags) {
  const std::string extension = std::filesystem::path(flags.out).extension().string();
  if (extension != ".html" && extension != ".htm" && !isStream(flags.out))
    throw UsageError(fmt::format("-o {}: the name must end in .html", flags.out));
  checkOutput(flags.out);
  writeTextFile(flags.out, reportHtml(flags.folder));
  say(fmt::format("wrote {}\n", flags.out));
  return 0;
}

Run addReport(CLI::App* verb) {
  auto flags = std::make_shared<ReportFlags>();
  offersFolders(
      verb->add_option("DIR", flags->folder, "a folder written by gnomon compare -o or gnomon fog -o")->required());
  offersFiles(verb->add_option("-o,--out", flags->out, "the page: FILE.html")->required());
  return [flags] { return runReport(*flags); };
}

}  // namespace

Verb reportVerb() {
  return {
      .name = "report", .sentence = "rebuilds the HTML report of a folder that compare or fog wrote", .add = addReport};
}

}  // namespace gnomon
