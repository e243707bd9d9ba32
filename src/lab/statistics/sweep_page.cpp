#include "lab/statistics/sweep_page.h"

#include "base/image.h"
#include "lab/statistics/answers_text.h"
#include "lab/statistics/sweep_page_text.h"
#include "lab/store/content_hash.h"

#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

using PageJson = nlohmann::json;

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

// Six digits: a pixel in a million.
PageJson number(double value, int digits = 6) {
  return std::isfinite(value) ? PageJson(std::stod(fmt::format("{:.{}g}", value, digits))) : PageJson(nullptr);
}

void add(PageJson& list, const Estimate& estimate) {
  list.push_back(number(estimate.value));
  list.push_back(estimate.interval ? number(estimate.interval->lower) : PageJson(nullptr));
  list.push_back(estimate.interval ? number(estimate.interval->upper) : PageJson(nullptr));
}

// The script knows the places: method, cases, mean, median and 95th percentile with their intervals, worst, all wrong
// with its interval, texels, build, shade, frame.
PageJson subsetJson(const Subset& subset) {
  PageJson json = PageJson::object();
  json["at"] = PageJson::array();
  for (const int at : {subset.scene, subset.map, subset.size}) json["at"].push_back(at);
  json["cases"] = subset.cases;
  json["methods"] = PageJson::array();
  for (const MethodAnswer& answer : subset.methods) {
    PageJson list = PageJson::array();
    list.push_back(answer.method);
    list.push_back(answer.error.count);
    add(list, answer.error.mean);
    add(list, answer.error.median);
    add(list, answer.error.p95);
    list.push_back(number(answer.error.worst));
    add(list, answer.allWrong);
    list.push_back(number(answer.texels));
    for (const std::optional<double>& ms : {answer.buildMs, answer.shadeMs, answer.frameMs})
      list.push_back(ms ? number(*ms) : PageJson(nullptr));
    json["methods"].push_back(std::move(list));
  }
  return json;
}

PageJson pairJson(const Pair& pair) {
  PageJson list = PageJson::array();
  for (const size_t count : {pair.a, pair.b, pair.cases, pair.aWins, pair.bWins}) list.push_back(count);
  add(list, pair.difference);
  return list;
}

// A list a case: scene, map, size, and each method's error, null where it has none; so that the page can tell pairs of
// what a person chooses. Null where it were megabytes.
PageJson casesJson(const CaseTable& table) {
  constexpr size_t kMostNumbers = 400000;
  constexpr size_t kFirst = 3;
  std::map<std::tuple<size_t, size_t, size_t>, PageJson> cases;
  for (const MeasuredCase& one : table.cases) {
    PageJson& list = cases[{one.view, one.map, one.size}];
    if (list.is_null()) {
      list = {one.scene, one.map, one.size};
      list.insert(list.end(), table.methods.size(), nullptr);
    }
    list[kFirst + one.method] = number(one.error, 9);
    if (cases.size() * table.methods.size() > kMostNumbers) return nullptr;
  }
  PageJson json = PageJson::array();
  for (auto& [place, list] : cases) json.push_back(std::move(list));
  return json;
}

PageJson dataOf(const Answers& answers) {
  const CaseTable& table = answers.table;
  PageJson data = PageJson::object();
  data["error"] = errorName(table.by);
  data["methods"] = table.methods;
  data["scenes"] = table.scenes;
  data["maps"] = table.maps;
  data["sizes"] = table.sizes;
  for (const char* list : {"subsets", "pairs", "worst"}) data[list] = PageJson::array();
  for (const Subset& subset : answers.subsets) data["subsets"].push_back(subsetJson(subset));
  for (const Pair& pair : answers.pairs) data["pairs"].push_back(pairJson(pair));
  data["cases"] = casesJson(table);
  data["pictures"] = PageJson::object();
  for (const WorstCase& worst : answers.worst) {
    PageJson one = PageJson::object();
    one["method"] = worst.method;
    one["error"] = number(worst.error);
    one["scene"] = worst.scene;
    one["place"] =
        fmt::format("{}: light {}, camera {}, {} {}", worst.scene, worst.light, worst.camera, worst.map, worst.mapSize);
    one["map"] = worst.map;
    one["size"] = worst.mapSize;
    one["command"] = worst.command;
    if (!worst.png.empty()) {
      const std::string hash = hashOf(worst.png).substr(0, 16);
      one["picture"] = hash;
      one["label"] = worst.label;
      data["pictures"][hash] = "data:image/png;base64," + base64(worst.png);
    }
    data["worst"].push_back(std::move(one));
  }
  return data;
}

std::string staticRanking(const Answers& answers) {
  std::string rows;
  for (const MethodAnswer& answer : answers.whole().methods)
    rows += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        escaped(answers.table.methods[answer.method]), answer.error.count,
                        perCentOf(answer.error.mean.value), perCentOf(answer.error.median.value),
                        perCentOf(answer.error.p95.value), perCentOf(answer.error.worst));
  return "<div class=\"scroll\"><table><thead><tr><th>method</th><th>cases</th><th>mean, %</th><th>median, "
         "%</th><th>95th, "
         "%</th><th>worst, %</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>";
}

std::string filled(std::string page, const std::map<std::string, std::string>& texts) {
  for (size_t at = page.find("{{"); at != std::string::npos; at = page.find("{{", at)) {
    const size_t end = page.find("}}", at);
    const auto found = texts.find(page.substr(at + 2, end - at - 2));
    const std::string& text = found->second;
    page.replace(at, end + 2 - at, text);
    at += text.size();
  }
  return page;
}

}  // namespace

std::string sweepPage(const Answers& answers, const std::string& version) {
  const CaseTable& table = answers.table;
  // No tag may end within the script.
  std::string data = dataOf(answers).dump(-1, ' ', false, PageJson::error_handler_t::replace), safe;
  for (const char c : data) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return filled(kSweepHtml, {{"title", escaped(table.name.empty() ? "A sweep" : table.name)},
                             {"style", kSweepCss},
                             {"script", kSweepJs},
                             {"data", safe},
                             {"facts", escaped(factsText(answers))},
                             {"intervals", escaped(howIntervals(answers))},
                             {"ranking", staticRanking(answers)},
                             {"version", escaped(version)},
                             {"programs", escaped(fmt::format("{}", fmt::join(table.programs, "; ")))},
                             {"devices", escaped(fmt::format("{}", fmt::join(table.devices, "; ")))},
                             {"machines", escaped(fmt::format("{}", fmt::join(table.machines, "; ")))}});
}

}  // namespace gnomon
