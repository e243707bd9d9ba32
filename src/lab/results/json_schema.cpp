#include "lab/results/json_schema.h"

#include "lab/results/comparison.h"
#include "lab/results/media_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

// The schema of a value of each type; T is only a name here.
template <typename T>
struct SchemaOf;

template <typename T>
Json schemaOf() {
  return SchemaOf<T>::make();
}

// Member by member: of nested lists in braces clang 14 leaves some copies behind (LeakSanitizer found them).
Json ofType(const char* type) {
  Json schema = Json::object();
  schema["type"] = type;
  return schema;
}

Json oneOfWords(std::initializer_list<const char*> words) {
  Json schema = Json::object();
  for (const char* word : words) schema["enum"].push_back(word);
  return schema;
}

Json objectOf(const Json& values) {
  Json schema = ofType("object");
  schema["additionalProperties"] = values;
  return schema;
}

Json arrayOf(const Json& items) {
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
struct SchemaOf<glm::vec3> {
  static Json make() {
    Json schema = arrayOf(ofType("number"));
    schema["minItems"] = 3;
    schema["maxItems"] = 3;
    return schema;
  }
};
template <>
struct SchemaOf<Bound> {
  static Json make() { return oneOfWords({"exact", "at_least", "at_most"}); }
};
template <>
struct SchemaOf<ErrorMeasure> {
  static Json make() { return oneOfWords({"rel_rmse", "rel_rmse_99"}); }
};
template <>
struct SchemaOf<NamedTexts> {
  static Json make() { return objectOf(ofType("string")); }
};
template <>
struct SchemaOf<std::vector<std::pair<std::string, Pictures>>> {
  static Json make() { return objectOf(schemaOf<Pictures>()); }
};
template <>
struct SchemaOf<Params> {
  static Json make() {
    Json value = Json::object();
    value["type"].push_back("string");
    value["type"].push_back("number");
    return objectOf(value);
  }
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
    return schema;
  }
};

}  // namespace

std::string resultsJsonSchema() {
  Json comparison = schemaOf<Comparison>(), media = schemaOf<MediaResults>();
  // What tells the two apart: the rows of the other kind are none.
  comparison["properties"]["media"]["maxItems"] = 0;
  for (const char* rows : {"rows", "maps", "truths"}) media["properties"][rows]["maxItems"] = 0;
  for (Json* kind : {&comparison, &media}) {
    Json version = Json::object();
    version["const"] = kResultsVersion;
    (*kind)["properties"]["schema"] = version;
  }
  Json schema = Json::object();
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = fmt::format("Gnomon's results.json, schema {}", kResultsVersion);
  schema["description"] = "Of gnomon compare and gnomon fog. docs/results.md explains it; lengths are metres.";
  schema["oneOf"].push_back(comparison);
  schema["oneOf"].push_back(media);
  return schema.dump(1) + "\n";
}

}  // namespace gnomon
