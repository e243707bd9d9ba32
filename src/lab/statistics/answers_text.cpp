#include "lab/statistics/answers_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

std::string nameOf(const CaseTable& table, const Subset& subset, int part) {
  if (part == 0) return subset.scene < 0 ? "all" : table.scenes[static_cast<size_t>(subset.scene)];
  if (part == 1) return subset.map < 0 ? "all" : table.maps[static_cast<size_t>(subset.map)];
  return subset.size < 0 ? "all" : fmt::format("{}", table.sizes[static_cast<size_t>(subset.size)]);
}

std::string intervalText(const Estimate& estimate) {
  if (!estimate.interval) return perCentOf(estimate.value);
  return fmt::format("{} [{}, {}]", perCentOf(estimate.value), perCentOf(estimate.interval->lower),
                     perCentOf(estimate.interval->upper));
}

std::string timeText(const std::optional<double>& ms) {
  return ms ? fmt::format("{:.3g}", *ms) : "-";
}

std::string csvText(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csvNumber(const std::optional<double>& number) {
  return number ? fmt::format("{:.9g}", *number) : "";
}

std::string csvEstimate(const Estimate& estimate) {
  const auto end = [&](bool upper) {
    return estimate.interval ? csvNumber(upper ? estimate.interval->upper : estimate.interval->lower) : "";
  };
  return fmt::format("{:.9g},{},{}", estimate.value, end(false), end(true));
}

std::string latexText(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) safe += '\\';
    if (c == '\\' || c == '~' || c == '^') {
      safe += c == '\\' ? "\\textbackslash{}" : fmt::format("\\{}{{}}", c);
      continue;
    }
    safe += c;
  }
  return safe;
}

std::string markdownText(std::string text) {
  for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

using Table = std::vector<std::vector<std::string>>;

std::string markdownTable(const Table& rows) {
  std::string text;
  for (size_t i = 0; i < rows.size(); ++i) {
    for (const std::string& cell : rows[i]) text += "| " + cell + " ";
    text += "|\n";
    if (i > 0) continue;
    for (size_t c = 0; c < rows[i].size(); ++c) text += "|---";
    text += "|\n";
  }
  return text;
}

std::string latexTable(const Table& rows, const std::string& caption) {
  std::string text = fmt::format("\\begin{{table}}\n\\caption{{{}}}\n\\begin{{tabular}}{{l{}}}\n\\toprule\n", caption,
                                 std::string(rows.front().size() - 1, 'r'));
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t c = 0; c < rows[i].size(); ++c) text += (c == 0 ? "" : " & ") + latexText(rows[i][c]);
    text += i == 0 ? " \\\\\n\\midrule\n" : " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

Table rankingTable(const Answers& answers, bool withIntervals) {
  const auto text = [&](const Estimate& estimate) {
    return withIntervals ? intervalText(estimate) : perCentOf(estimate.value);
  };
  Table rows = {
      {"method", "cases", "mean, %", "median, %", "95th, %", "worst, %", "all wrong, %", "map ms", "look-up ms"}};
  for (const MethodAnswer& answer : answers.whole().methods)
    rows.push_back({answers.table.methods[answer.method], fmt::format("{}", answer.error.count),
                    text(answer.error.mean), text(answer.error.median), text(answer.error.p95),
                    perCentOf(answer.error.worst), text(answer.allWrong), timeText(answer.buildMs),
                    timeText(answer.shadeMs)});
  return rows;
}

// The best method against each other.
Table pairsTable(const Answers& answers) {
  Table rows = {{"against", "cases", "wins", "losses", "ties", "mean difference, %"}};
  const size_t best = answers.whole().methods.front().method;
  for (const Pair& pair : answers.pairs)
    if (pair.a == best)
      rows.push_back({answers.table.methods[pair.b], fmt::format("{}", pair.cases), fmt::format("{}", pair.aWins),
                      fmt::format("{}", pair.bWins), fmt::format("{}", pair.cases - pair.aWins - pair.bWins),
                      intervalText(pair.difference)});
  return rows;
}

// `part`: a scene a column, or a map.
Table heatTable(const Answers& answers, bool byMap) {
  const std::vector<std::string>& columns = byMap ? answers.table.maps : answers.table.scenes;
  Table rows = {{"method"}};
  rows.front().insert(rows.front().end(), columns.begin(), columns.end());
  for (const MethodAnswer& answer : answers.whole().methods) {
    std::vector<std::string> row = {answers.table.methods[answer.method]};
    for (size_t i = 0; i < columns.size(); ++i) {
      const int at = static_cast<int>(i);
      const Subset* subset = byMap ? answers.find(-1, at, -1) : answers.find(at, -1, -1);
      const auto found = subset == nullptr ? std::vector<MethodAnswer>::const_iterator()
                                           : std::ranges::find(subset->methods, answer.method, &MethodAnswer::method);
      row.push_back(subset == nullptr || found == subset->methods.end() ? "-" : perCentOf(found->error.mean.value));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Table paretoTable(const Answers& answers, bool byTime) {
  std::vector<ParetoPoint> front;
  for (const ParetoPoint& point : answers.pareto)
    if (byTime ? point.leastTime : point.leastTexels) front.push_back(point);
  std::ranges::sort(front, {}, [&](const ParetoPoint& p) { return byTime ? p.frameMs.value_or(0.0) : p.texels; });
  Table rows = {{byTime ? "frame, ms" : "texels", "method", "map", "side", "mean, %"}};
  for (const ParetoPoint& point : front)
    rows.push_back({byTime ? timeText(point.frameMs) : fmt::format("{:.0f}", point.texels),
                    answers.table.methods[point.method], answers.table.maps[point.map],
                    fmt::format("{}", answers.table.sizes[point.size]), perCentOf(point.error)});
  return rows;
}

using Json = nlohmann::ordered_json;

Json jsonOf(const Estimate& estimate) {
  Json json = Json::object();
  json["value"] = estimate.value;
  json["lower"] = nullptr;
  json["upper"] = nullptr;
  if (estimate.interval) json["lower"] = estimate.interval->lower;
  if (estimate.interval) json["upper"] = estimate.interval->upper;
  return json;
}

Json jsonOf(const std::optional<double>& number) {
  return number ? Json(*number) : Json(nullptr);
}

}  // namespace

std::string perCentOf(double share) {
  const double percent = 100.0 * share;
  if (percent == 0.0) return "0";
  if (std::abs(percent) < 0.0005) return fmt::format("{:.1g}", percent);
  return fmt::format("{:.{}f}", percent,
                     std::abs(percent) >= 10.0  ? 1
                     : std::abs(percent) >= 1.0 ? 2
                     : std::abs(percent) >= 0.1 ? 3
                                                : 4);
}

std::string factsText(const Answers& answers) {
  const CaseTable& table = answers.table;
  std::string facts = fmt::format("{} cases on {} scenes, {} methods, {} rows.", answers.whole().cases,
                                  table.scenes.size(), table.methods.size(), table.cases.size());
  if (table.empty > 0) facts += fmt::format(" {} cases light nothing that their camera sees.", table.empty);
  if (table.failed > 0) facts += fmt::format(" {} cases failed (table failure).", table.failed);
  if (table.superseded > 0) facts += fmt::format(" {} older rows are superseded, and left out.", table.superseded);
  if (table.media > 0)
    facts +=
        fmt::format(" {} rows of media are not among these: SELECT * FROM media_results, with sqlite3.", table.media);
  return facts;
}

std::string howIntervals(const Answers& answers) {
  return fmt::format(
      "Intervals (in brackets, where there is room): 95%, by the bootstrap, {} resamples of whole {} ({} of them), "
      "seed {}. {}",
      kResamples, answers.byScenes ? "scenes" : "views (a camera and a light)", answers.groups, kBootstrapSeed,
      answers.byScenes
          ? "Cases of one scene are alike: drawing single cases would make the intervals too narrow."
          : fmt::format("With fewer than {} scenes nothing is said of scenes that were not measured.", kFewScenes));
}

std::string rankingText(const Answers& answers, size_t width) {
  const Table rows = rankingTable(answers, width == 0 || width >= 150);
  std::vector<size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text = fmt::format("by {}, of a case\n", errorName(answers.table.by));
  for (const auto& row : rows) {
    std::string line = fmt::format("{:<{}}", row[0], widths[0]);
    for (size_t c = 1; c < row.size(); ++c) line += fmt::format("  {:>{}}", row[c], widths[c]);
    text += line + "\n";
  }
  return text;
}

std::string answersCsv(const Answers& answers) {
  std::string text = "scene,map,map_size,method,cases";
  for (const char* name : {"mean", "median", "p95"}) text += fmt::format(",{0},{0}_lower,{0}_upper", name);
  text +=
      ",worst,mean_all_wrong,mean_all_wrong_lower,mean_all_wrong_upper,mean_bias_error,mean_bias_error_lower,"
      "mean_bias_error_upper,texels,build_ms,shade_ms,frame_ms,ranked_by\n";
  for (const Subset& subset : answers.subsets)
    for (const MethodAnswer& answer : subset.methods)
      text += fmt::format("{},{},{},{},{},{},{},{},{:.9g},{},{},{:.9g},{},{},{},{}\n",
                          csvText(nameOf(answers.table, subset, 0)), csvText(nameOf(answers.table, subset, 1)),
                          nameOf(answers.table, subset, 2), csvText(answers.table.methods[answer.method]),
                          answer.error.count, csvEstimate(answer.error.mean), csvEstimate(answer.error.median),
                          csvEstimate(answer.error.p95), answer.error.worst, csvEstimate(answer.allWrong),
                          csvEstimate(answer.biasError), answer.texels, csvNumber(answer.buildMs),
                          csvNumber(answer.shadeMs), csvNumber(answer.frameMs), errorName(answers.table.by));
  return text;
}

std::string answersLatex(const Answers& answers) {
  const std::string by = latexText(errorName(answers.table.by));
  return "% \\usepackage{booktabs}. Made by gnomon report.\n" +
         latexTable(rankingTable(answers, true),
                    fmt::format("{} of the scored pixels. {}", by, latexText(howIntervals(answers)))) +
         latexTable(pairsTable(answers),
                    fmt::format("{} against each other method, case by case.",
                                latexText(answers.table.methods[answers.whole().methods.front().method]))) +
         latexTable(heatTable(answers, false), fmt::format("Mean {} by scene, per cent.", by)) +
         latexTable(heatTable(answers, true), fmt::format("Mean {} by map, per cent.", by));
}

std::string answersMarkdown(const Answers& answers) {
  const auto part = [](const char* name, const std::string& text) {
    return fmt::format("<!-- sweep:{0} -->\n{1}<!-- /sweep:{0} -->\n", name, text);
  };
  const auto table = [](Table rows) {
    for (auto& row : rows)
      for (std::string& cell : row) cell = markdownText(cell);
    return markdownTable(rows);
  };
  return part("facts", factsText(answers) + "\n") + part("ranking", table(rankingTable(answers, true))) +
         part("pairs", table(pairsTable(answers))) + part("scenes", table(heatTable(answers, false))) +
         part("maps", table(heatTable(answers, true))) + part("texels", table(paretoTable(answers, false))) +
         part("frames", table(paretoTable(answers, true))) + part("intervals", howIntervals(answers) + "\n");
}

std::string answersJson(const Answers& answers) {
  const CaseTable& table = answers.table;
  Json json = Json::object();
  json["name"] = table.name;
  json["error"] = errorName(table.by);
  json["cases"] = answers.whole().cases;
  json["rows"] = table.cases.size();
  json["intervals"] = howIntervals(answers);
  json["programs"] = table.programs;
  json["devices"] = table.devices;
  json["machines"] = table.machines;
  json["scenes"] = table.scenes;
  json["maps"] = table.maps;
  json["map_sizes"] = table.sizes;
  json["methods"] = Json::array();
  for (const Subset& subset : answers.subsets)
    for (const MethodAnswer& answer : subset.methods) {
      Json method = Json::object();
      method["scene"] = nameOf(table, subset, 0);
      method["map"] = nameOf(table, subset, 1);
      method["map_size"] = nameOf(table, subset, 2);
      method["method"] = table.methods[answer.method];
      method["cases"] = answer.error.count;
      method["mean"] = jsonOf(answer.error.mean);
      method["median"] = jsonOf(answer.error.median);
      method["p95"] = jsonOf(answer.error.p95);
      method["worst"] = answer.error.worst;
      method["all_wrong"] = jsonOf(answer.allWrong);
      method["bias_error"] = jsonOf(answer.biasError);
      method["texels"] = answer.texels;
      method["build_ms"] = jsonOf(answer.buildMs);
      method["shade_ms"] = jsonOf(answer.shadeMs);
      method["frame_ms"] = jsonOf(answer.frameMs);
      json["methods"].push_back(std::move(method));
    }
  json["pairs"] = Json::array();
  for (const Pair& pair : answers.pairs) {
    Json one = Json::object();
    one["better"] = table.methods[pair.a];
    one["worse"] = table.methods[pair.b];
    one["cases"] = pair.cases;
    one["wins"] = pair.aWins;
    one["losses"] = pair.bWins;
    one["difference"] = jsonOf(pair.difference);
    json["pairs"].push_back(std::move(one));
  }
  json["pareto"] = Json::array();
  for (const ParetoPoint& point : answers.pareto) {
    Json one = Json::object();
    one["method"] = table.methods[point.method];
    one["map"] = table.maps[point.map];
    one["map_size"] = table.sizes[point.size];
    one["error"] = point.error;
    one["texels"] = point.texels;
    one["frame_ms"] = jsonOf(point.frameMs);
    one["pareto_texels"] = point.leastTexels;
    one["pareto_frame"] = point.leastTime;
    json["pareto"].push_back(std::move(one));
  }
  json["worst"] = Json::array();
  for (const WorstCase& worst : answers.worst) {
    Json one = Json::object();
    one["method"] = table.methods[worst.method];
    one["error"] = worst.error;
    one["scene"] = worst.scene;
    one["light"] = worst.light;
    one["camera"] = worst.camera;
    one["map"] = worst.map;
    one["map_size"] = worst.mapSize;
    one["command"] = worst.command;
    json["worst"].push_back(std::move(one));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon
