#pragma once
// JSON schema, draft 2020-12, of records as they declare their fields (field.h): for the files that publish one.

#include "lab/results/schema.h"

#include <concepts>
#include <initializer_list>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon::json_schema {

using Json = nlohmann::ordered_json;

// The schema of a value of each type; T is only a name here.
template <typename T>
struct SchemaOf;

template <typename T>
Json schemaOf() {
  return SchemaOf<T>::make();
}

// Member by member: of nested lists in braces clang 14 leaves some copies behind (LeakSanitizer found them).
inline Json ofType(const char* type) {
  Json schema = Json::object();
  schema["type"] = type;
  return schema;
}

inline Json oneOfWords(std::initializer_list<const char*> words) {
  Json schema = Json::object();
  for (const char* word : words) schema["enum"].push_back(word);
  return schema;
}

inline Json objectOf(const Json& values) {
  Json schema = ofType("object");
  schema["additionalProperties"] = values;
  return schema;
}

inline Json arrayOf(const Json& items) {
  Json schema = ofType("array");
  schema["items"] = items;
  return schema;
}

template <>
struct SchemaOf<bool> {
  static Json make() { return ofType("boolean"); }
};
template <std::integral T>
struct SchemaOf<T> {
  static Json make() {
    Json schema = ofType("integer");
    schema["minimum"] = 0;
    return schema;
  }
};
template <std::floating_point T>
struct SchemaOf<T> {
  static Json make() { return ofType("number"); }
};
template <>
struct SchemaOf<std::string> {
  static Json make() { return ofType("string"); }
};
template <>
struct SchemaOf<NamedTexts> {
  static Json make() { return objectOf(ofType("string")); }
};
template <typename T>
struct SchemaOf<std::optional<T>> {
  static Json make() { return schemaOf<T>(); }
};
template <typename T>
struct SchemaOf<std::vector<T>> {
  static Json make() { return arrayOf(schemaOf<T>()); }
};
template <Record R>
struct SchemaOf<R> {
  static Json make() {
    Json properties = Json::object(), required = Json::array();
    forEachField<R>([&](const auto& field) {
      if (!field.notes.inFile) return;
      using Value = std::remove_cvref_t<decltype(std::invoke(field.get, std::declval<const R&>()))>;
      Json value = schemaOf<Value>();
      std::string says = field.notes.says;
      if (*field.notes.unit != '\0') says = fmt::format("[{}] {}", field.notes.unit, says);
      if (field.notes.least > -1e300) value["minimum"] = field.notes.least;
      if (field.notes.most < 1e300) value["maximum"] = field.notes.most;
      const bool isNullable = kIsOptional<Value> && field.notes.absent != Absent::LeftOut;
      if (isNullable) {
        Json either = Json::object();
        either["anyOf"].push_back(value);
        either["anyOf"].push_back(ofType("null"));
        value = either;
      }
      value["description"] = says;
      properties[field.name] = value;
      if (field.notes.absent == Absent::Refused) required.push_back(field.name);
    });
    Json schema = ofType("object");
    schema["properties"] = properties;
    schema["required"] = required;
    schema["additionalProperties"] = false;
    if constexpr (requires { R::kShorthand; }) {  // the field alone stands for the record
      Json either = Json::object();
      either["anyOf"].push_back(properties[R::kShorthand]);
      either["anyOf"].push_back(schema);
      return either;
    }
    return schema;
  }
};

}  // namespace gnomon::json_schema
