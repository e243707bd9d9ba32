#pragma once
// A field of results.json while it is read: it knows its path, so that an error message can name it.

#include "lab/results/schema.h"

#include <cstdint>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

class JsonField {
 public:
  // `file`: for messages; outlives the field, as does `json`. `where`: "rows[3].bias".
  JsonField(const nlohmann::ordered_json& json, const std::string& file, std::string where)
      : json_(json), file_(file), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& what) const;

  bool has(const char* key) const;  // and is not null
  JsonField operator[](const char* key) const;
  bool isNull() const { return json_.is_null(); }
  bool isArray() const { return json_.is_array(); }
  bool isEmpty() const { return json_.empty(); }

  // Each throws WorldError where the field is something else.
  std::string text() const;
  double number() const;
  uint64_t count() const;
  bool flag() const;
  std::variant<std::string, int64_t, double> scalar() const;  // a list or object as its text
  std::vector<double> numbers() const;

  template <typename Visit>
  void forItems(const Visit& visit) const {
    if (!json_.is_array()) fail("must be a list");
    for (size_t i = 0; i < json_.size(); ++i) visit(JsonField(json_[i], file_, fmt::format("{}[{}]", where_, i)));
  }
  template <typename Visit>
  void forMembers(const Visit& visit) const {
    if (!json_.is_object()) fail("must be an object");
    for (const auto& [key, value] : json_.items()) visit(key, JsonField(value, file_, where_ + "." + key));
  }

 private:
  const nlohmann::ordered_json& json_;
  const std::string& file_;
  std::string where_;
};

}  // namespace gnomon
