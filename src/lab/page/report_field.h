#pragma once
// results.json, field by field: each knows where it stands, so that a message can say which one is wrong.

#include "lab/page/report_data.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

inline constexpr int kMaxPictureSide = 16384;  // pixels

class ReportField {
 public:
  // `file`: for messages; outlives the field, as does `json`. `where`: "rows[3].bias".
  ReportField(const nlohmann::ordered_json& json, const std::string& file, std::string where)
      : json_(json), file_(file), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& what) const;

  bool has(const char* key) const;  // and is not null
  ReportField operator[](const char* key) const;
  bool isNumber() const { return json_.is_number(); }
  bool isArray() const { return json_.is_array(); }
  bool isEmpty() const { return json_.empty(); }

  // Each throws WorldError where the field is something else.
  std::string text() const;
  double number() const;
  uint64_t count() const;
  int pixels() const;  // at most kMaxPictureSide
  bool flag() const;
  std::string anyText() const;  // any scalar, as a person writes it
  std::vector<double> numbers() const;
  ReportPictures pictures() const;
  std::optional<double> optionalNumber(const char* key) const;

  template <typename Visit>
  void forItems(const Visit& visit) const {
    if (!json_.is_array()) fail("must be a list");
    for (size_t i = 0; i < json_.size(); ++i) visit(ReportField(json_[i], file_, fmt::format("{}[{}]", where_, i)));
  }
  template <typename Visit>
  void forMembers(const Visit& visit) const {
    if (!json_.is_object()) fail("must be an object");
    for (const auto& [key, value] : json_.items()) visit(key, ReportField(value, file_, where_ + "." + key));
  }

 private:
  const nlohmann::ordered_json& json_;
  const std::string& file_;
  std::string where_;
};

// "1, 2.5, 3"
std::string vectorText(const std::vector<double>& v);

// A light in words.
std::string lightText(const ReportField& light);

}  // namespace gnomon
