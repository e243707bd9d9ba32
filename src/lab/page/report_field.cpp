#include "lab/page/report_field.h"

#include "base/error.h"

#include <cmath>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// Schema 1 listed paths only; their kind is in the name: "spot/dual.labels.png".
std::string kindOfPath(const std::string& path) {
  const fs::path file(path);
  if (file.extension() == ".exr") return "data";
  const std::string kind = file.stem().extension().string();
  return kind.empty() ? "picture" : kind.substr(1);
}

}  // namespace

void ReportField::fail(const std::string& what) const {
  throw fileError(file_, fmt::format("{} {}", where_.empty() ? "its value" : where_, what),
                  "write it anew with gnomon compare -o or gnomon fog -o");
}

bool ReportField::has(const char* key) const {
  return json_.is_object() && json_.contains(key) && !json_.at(key).is_null();
}

ReportField ReportField::operator[](const char* key) const {
  const std::string path = where_.empty() ? key : where_ + "." + key;
  if (!json_.is_object()) fail("must be an object");
  const auto found = json_.find(key);
  if (found == json_.end()) ReportField(json_, file_, path).fail("is missing");
  return {*found, file_, path};
}

std::string ReportField::text() const {
  if (!json_.is_string()) fail("must be a text");
  return json_.get<std::string>();
}

double ReportField::number() const {
  if (!json_.is_number() || !std::isfinite(json_.get<double>())) fail("must be a number");
  return json_.get<double>();
}

uint64_t ReportField::count() const {
  if (!json_.is_number_unsigned()) fail("must be a whole number, not negative");
  return json_.get<uint64_t>();
}

int ReportField::pixels() const {
  if (count() > kMaxPictureSide) fail(fmt::format("must be at most {}", kMaxPictureSide));
  return static_cast<int>(count());
}

bool ReportField::flag() const {
  if (!json_.is_boolean()) fail("must be true or false");
  return json_.get<bool>();
}

std::string ReportField::anyText() const {
  if (json_.is_string()) return json_.get<std::string>();
  if (json_.is_number_float()) return fmt::format("{}", json_.get<double>());
  return json_.dump();
}

std::vector<double> ReportField::numbers() const {
  std::vector<double> all;
  forItems([&](const ReportField& item) { all.push_back(item.number()); });
  return all;
}

ReportPictures ReportField::pictures() const {
  ReportPictures all;
  if (isArray())
    forItems([&](const ReportField& item) { all.emplace_back(kindOfPath(item.text()), item.text()); });
  else
    forMembers([&](const std::string& kind, const ReportField& path) { all.emplace_back(kind, path.text()); });
  return all;
}

std::optional<double> ReportField::optionalNumber(const char* key) const {
  if (!has(key)) return std::nullopt;
  return (*this)[key].number();
}

std::string vectorText(const std::vector<double>& v) {
  std::string text;
  for (const double x : v) text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", x);
  return text;
}

std::string lightText(const ReportField& light) {
  std::string text = light["name"].text();
  if (text.empty()) text = "unnamed";
  text += fmt::format(" ({})", light["type"].text());
  if (light.has("position")) text += fmt::format(" at {} m", vectorText(light["position"].numbers()));
  if (light.has("direction")) text += fmt::format(" towards {}", vectorText(light["direction"].numbers()));
  if (light.has("cone_degrees")) text += fmt::format(", cone {:.4g}°", light["cone_degrees"].number());
  return text;
}

}  // namespace gnomon
