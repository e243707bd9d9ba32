#include "lab/results/json_field.h"

#include "base/error.h"

#include <cmath>

namespace gnomon {

void JsonField::fail(const std::string& what) const {
  throw fileError(file_, fmt::format("{} {}", where_.empty() ? "its value" : where_, what),
                  "write it again with gnomon compare -o or gnomon fog -o");
}

bool JsonField::has(const char* key) const {
  return json_.is_object() && json_.contains(key) && !json_.at(key).is_null();
}

JsonField JsonField::operator[](const char* key) const {
  const std::string path = where_.empty() ? key : where_ + "." + key;
  if (!json_.is_object()) fail("must be an object");
  const auto found = json_.find(key);
  if (found == json_.end()) JsonField(json_, file_, path).fail("is missing");
  return {*found, file_, path};
}

std::string JsonField::text() const {
  if (!json_.is_string()) fail("must be a string");
  return json_.get<std::string>();
}

double JsonField::number() const {
  if (!json_.is_number() || !std::isfinite(json_.get<double>())) fail("must be a number");
  return json_.get<double>();
}

uint64_t JsonField::count() const {
  if (!json_.is_number_unsigned()) fail("must be a whole number, not negative");
  return json_.get<uint64_t>();
}

bool JsonField::flag() const {
  if (!json_.is_boolean()) fail("must be true or false");
  return json_.get<bool>();
}

std::variant<std::string, int64_t, double> JsonField::scalar() const {
  if (json_.is_string()) return json_.get<std::string>();
  if (json_.is_number_integer()) return json_.get<int64_t>();
  if (json_.is_number_float()) return json_.get<double>();
  return json_.dump();
}

std::vector<double> JsonField::numbers() const {
  std::vector<double> all;
  forItems([&](const JsonField& item) { all.push_back(item.number()); });
  return all;
}

}  // namespace gnomon
