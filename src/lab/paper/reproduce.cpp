#include "lab/paper/reproduce.h"

#include "base/error.h"
#include "base/suggest.h"
#include "lab/compare/results.h"
#include "lab/paper/paper_run.h"
#include "scene/generate.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

constexpr int kReproductionVersion = 1;
constexpr double kLeastScale = 0.05;

Json toJson(const JudgedClaim& judged) {
  Json json = {{"figure", judged.claim.figure},
               {"claim", judged.claim.says},
               {"run", judged.claim.run},
               {"verdict", verdictName(judged.verdict)}};
  json["rule"] = Json::array();
  for (size_t i = 0; i < judged.claim.conditions.size(); ++i) {
    Json condition = {{"condition", judged.claim.conditions[i]}};
    condition["holds"] = judged.conditions.empty() ? Json(nullptr) : Json(judged.conditions[i].holds);
    json["rule"].push_back(condition);
  }
  json["numbers"] = Json::object();
  for (const auto& [name, value] : judged.numbers) json["numbers"][name] = value;
  if (!judged.missing.empty()) json["missing"] = judged.missing;
  return json;
}

}  // namespace

const std::vector<std::string>& reproduciblePapers() {
  static const std::vector<std::string> papers = {"weiskopf2003", "dou2014"};
  return papers;
}

Reproduction reproduce(const gpu::DeviceOptions& device, const ReproduceOptions& options) {
  if (std::ranges::find(reproduciblePapers(), options.paper) == reproduciblePapers().end())
    throw UsageError(fmt::format("reproduce {}: no such paper; {}", options.paper,
                                 chooseFrom(options.paper, fmt::format("{}", fmt::join(reproduciblePapers(), ", ")))));
  if (!(options.scale >= kLeastScale && options.scale <= 1.0))
    throw UsageError(fmt::format("--scale {:g} is outside {:g}..1", options.scale, kLeastScale));
  // A user's scene is refused here; later on, what it lacks leaves out a figure.
  if (!options.scene.empty()) openScene(options.scene);
  const auto start = std::chrono::steady_clock::now();
  Reproduction result =
      options.paper == "dou2014" ? reproduceDou2014(device, options) : reproduceWeiskopf2003(device, options);
  if (result.figures.empty() && !result.leftOut.empty()) throw WorldError(result.leftOut.front().why);
  result.scale = options.scale;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::string reproductionText(const Reproduction& reproduction) {
  std::string text;
  for (const JudgedClaim& judged : reproduction.claims)
    text += fmt::format("{:<19} {:<10} {} [{}]\n", verdictName(judged.verdict), judged.claim.figure, judged.claim.says,
                        evidenceText(judged));
  for (const LeftOut& left : reproduction.leftOut)
    text += fmt::format("left out            {}: {}\n", left.what, left.why);
  std::vector<size_t> counts(4);
  for (const JudgedClaim& judged : reproduction.claims) ++counts[static_cast<size_t>(judged.verdict)];
  text += fmt::format("{}: {} claims; {} hold, {} hold in part, {} do not hold here", reproduction.paper,
                      reproduction.claims.size(), counts[0], counts[1], counts[2]);
  if (reproduction.scale != 1.0)
    text = fmt::format("at scale {:g}: the verdicts are meant for scale 1, whose pictures and maps are the papers'\n",
                       reproduction.scale) +
           text;
  if (counts[3] > 0) text += fmt::format(", {} were not run", counts[3]);
  return text + fmt::format("; {:.0f} s\n", reproduction.seconds);
}

std::string reproductionJson(const Reproduction& reproduction, const ReproduceOptions& options,
                             const std::string& command) {
  Json json;
  json["schema"] = kReproductionVersion;
  json["gnomon"] = {{"version", gnomonVersion()}, {"device", reproduction.device}, {"command", command}};
  json["paper"] = reproduction.paper;
  json["citation"] = reproduction.citation;
  json["scale"] = options.scale;
  json["claims"] = Json::array();
  for (const JudgedClaim& judged : reproduction.claims) json["claims"].push_back(toJson(judged));
  json["left_out"] = Json::array();
  for (const LeftOut& left : reproduction.leftOut) json["left_out"].push_back({{"what", left.what}, {"why", left.why}});
  json["tables"] = Json::array();
  for (const PaperTable& table : reproduction.tables)
    json["tables"].push_back({{"table", table.id},
                              {"title", table.title},
                              {"note", table.note},
                              {"columns", table.columns},
                              {"rows", table.rows}});
  json["numbers"] = Json::object();
  for (const auto& [name, value] : reproduction.numbers) json["numbers"][name] = value;
  json["comparisons"] = Json::array();
  for (const auto& [name, results] : reproduction.comparisons)
    json["comparisons"].push_back({{"folder", name}, {"results", Json::parse(results)}});
  json["total_ms"] = 1000.0 * reproduction.seconds;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon
