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

Json ofType(const char* type) {
  return {{"type", type}};
}

template <>
struct SchemaOf<bool> {
  static Json make() { return ofType("boolean"); }
};
template <std::integral T>
struct SchemaOf<T> {
  static Json make() { return {{"type", "integer"}, {"minimum", 0}}; }
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
  static Json make() { return {{"type", "array"}, {"items", ofType("number")}, {"minItems", 3}, {"maxItems", 3}}; }
};
template <>
struct SchemaOf<Bound> {
  static Json make() { return {{"enum", {"exact", "at_least", "at_most"}}}; }
};
template <>
struct SchemaOf<ErrorMeasure> {
  static Json make() { return {{"enum", {"rel_rmse", "rel_rmse_99"}}}; }
};
template <>
struct SchemaOf<NamedTexts> {
  static Json make() { return {{"type", "object"}, {"additionalProperties", ofType("string")}}; }
};
template <>
struct SchemaOf<std::vector<std::pair<std::string, Pictures>>> {
  static Json make() { return {{"type", "object"}, {"additionalProperties", schemaOf<Pictures>()}}; }
};
template <>
struct SchemaOf<Params> {
  static Json make() { return {{"type", "object"}, {"additionalProperties", {{"type", {"string", "number"}}}}}; }
};
template <typename T>
struct SchemaOf<std::optional<T>> {
  static Json make() { return schemaOf<T>(); }
};
template <typename T>
struct SchemaOf<std::vector<T>> {
  static Json make() { return {{"type", "array"}, {"items", schemaOf<T>()}}; }
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
      if (isNullable) value = {{"anyOf", {value, ofType("null")}}};
      value["description"] = says;
      properties[field.name] = value;
      if (field.notes.absent == Absent::Refused) required.push_back(field.name);
    });
    return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
  }
};

}  // namespace

std::string resultsJsonSchema() {
  Json comparison = schemaOf<Comparison>(), media = schemaOf<MediaResults>();
  // What tells the two apart: the rows of the other kind are none.
  comparison["properties"]["media"]["maxItems"] = 0;
  for (const char* rows : {"rows", "maps", "truths"}) media["properties"][rows]["maxItems"] = 0;
  for (Json* kind : {&comparison, &media}) (*kind)["properties"]["schema"] = {{"const", kResultsVersion}};
  const Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", fmt::format("Gnomon's results.json, schema {}", kResultsVersion)},
      {"description", "Of gnomon compare and gnomon fog. docs/results.md explains it; lengths are metres."},
      {"oneOf", {comparison, media}}};
  return schema.dump(1) + "\n";
}

}  // namespace gnomon
