#include "lab/results/json_schema.h"

#include "lab/results/comparison.h"
#include "lab/results/json_schema_of.h"
#include "lab/results/media_results.h"

#include <fmt/format.h>

namespace gnomon {

namespace json_schema {

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
}  // namespace json_schema

std::string resultsJsonSchema() {
  using namespace json_schema;
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
