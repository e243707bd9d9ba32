#include "scene/gltf_check.h"

#include "base/error.h"
#include "base/message.h"
#include "scene/gltf_document.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

using nlohmann::json;

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

// Natural: an integer from 0 to 2^53. Index: a natural below the size of the root array `detail`. Object,
// Objects: of the shape `detail`. IndexMap: an object whose values are indices into `detail`; NaturalMap: are naturals.
enum class Kind { Text, Flag, Number, Natural, Index, Numbers, Indices, Object, Objects, IndexMap, NaturalMap };

struct Rule {
  const char* property;
  Kind kind;
  bool required = false;
  const char* detail = "";
  size_t length = 0;  // of Numbers; 0: any
};

constexpr bool kRequired = true;

// What Gnomon reads, by the shape's name. Everything else is dropped.
const std::map<std::string_view, std::vector<Rule>>& shapes() {
  static const std::map<std::string_view, std::vector<Rule>> all = {
      {"glTF",
       {{"asset", Kind::Object, kRequired, "asset"},
        {"buffers", Kind::Objects, false, "buffer"},
        {"bufferViews", Kind::Objects, false, "bufferView"},
        {"accessors", Kind::Objects, false, "accessor"},
        {"images", Kind::Objects, false, "image"},
        {"samplers", Kind::Objects, false, "sampler"},
        {"textures", Kind::Objects, false, "texture"},
        {"materials", Kind::Objects, false, "material"},
        {"meshes", Kind::Objects, false, "mesh"},
        {"cameras", Kind::Objects, false, "camera"},
        {"nodes", Kind::Objects, false, "node"},
        {"scenes", Kind::Objects, false, "scene"},
        {"scene", Kind::Index, false, "scenes"},
        {"extensions", Kind::Object, false, "glTF extensions"}}},
      {"asset", {{"version", Kind::Text, kRequired}}},
      {"buffer",
       {{"byteLength", Kind::Natural, kRequired},
        {"uri", Kind::Text},
        {"extensions", Kind::Object, false, "buffer extensions"}}},
      {"buffer extensions", {{"EXT_meshopt_compression", Kind::Object, false, "meshopt buffer"}}},
      {"meshopt buffer", {{"fallback", Kind::Flag}}},
      {"bufferView",
       {{"buffer", Kind::Index, kRequired, "buffers"},
        {"byteOffset", Kind::Natural},
        {"byteLength", Kind::Natural, kRequired},
        {"byteStride", Kind::Natural},
        {"extensions", Kind::Object, false, "bufferView extensions"}}},
      {"bufferView extensions", {{"EXT_meshopt_compression", Kind::Object, false, "EXT_meshopt_compression"}}},
      {"EXT_meshopt_compression",
       {{"buffer", Kind::Index, kRequired, "buffers"},
        {"byteOffset", Kind::Natural},
        {"byteLength", Kind::Natural, kRequired},
        {"byteStride", Kind::Natural, kRequired},
        {"count", Kind::Natural, kRequired},
        {"mode", Kind::Text, kRequired},
        {"filter", Kind::Text}}},
      {"accessor",
       {{"bufferView", Kind::Index, false, "bufferViews"},
        {"byteOffset", Kind::Natural},
        {"componentType", Kind::Natural, kRequired},
        {"count", Kind::Natural, kRequired},
        {"type", Kind::Text, kRequired},
        {"normalized", Kind::Flag},
        {"sparse", Kind::Object, false, "sparse"}}},
      {"sparse",
       {{"count", Kind::Natural, kRequired},
        {"indices", Kind::Object, kRequired, "sparse part"},
        {"values", Kind::Object, kRequired, "sparse part"}}},
      {"sparse part",
       {{"bufferView", Kind::Index, kRequired, "bufferViews"},
        {"byteOffset", Kind::Natural},
        {"componentType", Kind::Natural}}},
      {"image", {{"name", Kind::Text}, {"uri", Kind::Text}, {"bufferView", Kind::Index, false, "bufferViews"}}},
      {"sampler",
       {{"magFilter", Kind::Natural},
        {"minFilter", Kind::Natural},
        {"wrapS", Kind::Natural},
        {"wrapT", Kind::Natural}}},
      {"texture", {{"sampler", Kind::Index, false, "samplers"}, {"source", Kind::Index, false, "images"}}},
      {"material",
       {{"name", Kind::Text},
        {"alphaMode", Kind::Text},
        {"alphaCutoff", Kind::Number},
        {"doubleSided", Kind::Flag},
        {"pbrMetallicRoughness", Kind::Object, false, "pbrMetallicRoughness"}}},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", Kind::Numbers, false, "", 4},
        {"baseColorTexture", Kind::Object, false, "baseColorTexture"}}},
      {"baseColorTexture",
       {{"index", Kind::Index, kRequired, "textures"},
        {"texCoord", Kind::Natural},
        {"extensions", Kind::Object, false, "texture extensions"}}},
      {"texture extensions", {{"KHR_texture_transform", Kind::Object, false, "KHR_texture_transform"}}},
      {"KHR_texture_transform",
       {{"offset", Kind::Numbers, false, "", 2},
        {"rotation", Kind::Number},
        {"scale", Kind::Numbers, false, "", 2},
        {"texCoord", Kind::Natural}}},
      {"mesh",
       {{"name", Kind::Text}, {"primitives", Kind::Objects, kRequired, "primitive"}, {"weights", Kind::Numbers}}},
      {"primitive",
       {{"attributes", Kind::IndexMap, kRequired, "accessors"},
        {"indices", Kind::Index, false, "accessors"},
        {"material", Kind::Index, false, "materials"},
        {"mode", Kind::Natural},
        {"extensions", Kind::Object, false, "primitive extensions"}}},
      {"primitive extensions", {{"KHR_draco_mesh_compression", Kind::Object, false, "KHR_draco_mesh_compression"}}},
      {"KHR_draco_mesh_compression",
       {{"bufferView", Kind::Index, kRequired, "bufferViews"}, {"attributes", Kind::NaturalMap, kRequired}}},
      {"camera",
       {{"name", Kind::Text},
        {"type", Kind::Text, kRequired},
        {"perspective", Kind::Object, false, "perspective"},
        {"orthographic", Kind::Object, false, "orthographic"}}},
      {"perspective",
       {{"yfov", Kind::Number, kRequired}, {"znear", Kind::Number, kRequired}, {"aspectRatio", Kind::Number}}},
      {"orthographic",
       {{"xmag", Kind::Number, kRequired},
        {"ymag", Kind::Number, kRequired},
        {"zfar", Kind::Number, kRequired},
        {"znear", Kind::Number, kRequired}}},
      {"node",
       {{"name", Kind::Text},
        {"children", Kind::Indices, false, "nodes"},
        {"matrix", Kind::Numbers, false, "", 16},
        {"translation", Kind::Numbers, false, "", 3},
        {"rotation", Kind::Numbers, false, "", 4},
        {"scale", Kind::Numbers, false, "", 3},
        {"mesh", Kind::Index, false, "meshes"},
        {"camera", Kind::Index, false, "cameras"},
        {"skin", Kind::Natural},
        {"weights", Kind::Numbers},
        {"extensions", Kind::Object, false, "node extensions"}}},
      {"node extensions",
       {{"KHR_lights_punctual", Kind::Object, false, "light reference"},
        {"KHR_node_visibility", Kind::Object, false, "KHR_node_visibility"},
        {"EXT_mesh_gpu_instancing", Kind::Object, false, "EXT_mesh_gpu_instancing"}}},
      {"light reference", {{"light", Kind::Natural, kRequired}}},
      {"KHR_node_visibility", {{"visible", Kind::Flag}}},
      {"EXT_mesh_gpu_instancing", {{"attributes", Kind::IndexMap, kRequired, "accessors"}}},
      {"scene", {{"name", Kind::Text}, {"nodes", Kind::Indices, false, "nodes"}}},
      {"glTF extensions", {{"KHR_lights_punctual", Kind::Object, false, "KHR_lights_punctual"}}},
      {"KHR_lights_punctual", {{"lights", Kind::Objects, kRequired, "light"}}},
      {"light",
       {{"name", Kind::Text},
        {"type", Kind::Text, kRequired},
        {"color", Kind::Numbers, false, "", 3},
        {"intensity", Kind::Number},
        {"range", Kind::Number},
        {"spot", Kind::Object, false, "spot"}}},
      {"spot", {{"innerConeAngle", Kind::Number}, {"outerConeAngle", Kind::Number}}},
  };
  return all;
}

class Checker {
 public:
  Checker(const json& root, const std::string& fileName) : root_(root), fileName_(fileName) {}

  void checkObject(json& object, const std::string& where, std::string_view shape) const {
    const std::vector<Rule>& rules = shapes().at(shape);
    if (!object.is_object()) refuse(where, "is not a JSON object");
    for (auto it = object.begin(); it != object.end();) {
      const bool known =
          std::any_of(rules.begin(), rules.end(), [&](const Rule& rule) { return it.key() == rule.property; });
      it = known ? std::next(it) : object.erase(it);
    }
    for (const Rule& rule : rules) {
      const auto it = object.find(rule.property);
      if (it != object.end()) {
        checkValue(*it, where, rule);
      } else if (rule.required) {
        refuse(where, fmt::format("has no '{}'", rule.property));
      }
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& where, const std::string& what) const {
    throw fileError(fileName_, where + " " + what, kRemedy);
  }

  void checkValue(json& value, const std::string& where, const Rule& rule) const {
    const std::string named = fmt::format("{}: '{}'", where, rule.property);
    switch (rule.kind) {
      case Kind::Text:
        if (!value.is_string()) refuse(named, "is not a string");
        break;
      case Kind::Flag:
        if (!value.is_boolean()) refuse(named, "is neither true nor false");
        break;
      case Kind::Number:
        if (!value.is_number()) refuse(named, "is not a number");
        break;
      case Kind::Natural:
        checkNatural(value, named);
        break;
      case Kind::Index:
        checkIndex(value, named, rule.detail);
        break;
      case Kind::Numbers:
        checkNumbers(value, named, rule.length);
        break;
      case Kind::Indices:
        if (!value.is_array()) refuse(named, "is not an array");
        for (json& entry : value) checkIndex(entry, named, rule.detail);
        break;
      case Kind::Object:
        checkObject(value, where == "glTF" ? rule.property : named, rule.detail);
        break;
      case Kind::Objects:
        checkObjects(value, where, rule);
        break;
      case Kind::IndexMap:
        if (!value.is_object()) refuse(named, "is not a JSON object");
        for (auto& [key, entry] : value.items()) checkIndex(entry, fmt::format("{} '{}'", named, key), rule.detail);
        break;
      case Kind::NaturalMap:
        if (!value.is_object()) refuse(named, "is not a JSON object");
        for (auto& [key, entry] : value.items()) checkNatural(entry, fmt::format("{} '{}'", named, key));
        break;
    }
  }

  void checkObjects(json& value, const std::string& where, const Rule& rule) const {
    const std::string prefix = where == "glTF" ? "" : where + ", ";
    if (!value.is_array()) refuse(fmt::format("{}'{}'", prefix, rule.property), "is not an array");
    size_t i = 0;
    for (json& entry : value) checkObject(entry, fmt::format("{}{} {}", prefix, rule.detail, i++), rule.detail);
  }

  void checkNumbers(const json& value, const std::string& named, size_t length) const {
    if (!value.is_array()) refuse(named, "is not an array");
    if (length > 0 && value.size() != length)
      refuse(named, fmt::format("has {} numbers, not {}", value.size(), length));
    for (const json& entry : value)
      if (!entry.is_number()) refuse(named, "holds something that is not a number");
  }

  // Some exporters write 3.0 for 3; tinygltf wants 3.
  void checkNatural(json& value, const std::string& named) const {
    constexpr double kLargest = 9007199254740992.0;
    const double number = value.is_number() ? value.get<double>() : -1.0;
    if (number < 0.0 || number > kLargest || number != static_cast<double>(static_cast<uint64_t>(number)))
      refuse(named, "is not a whole number from 0 to 2^53");
    if (value.is_number_float()) value = static_cast<uint64_t>(number);
  }

  void checkIndex(json& value, const std::string& named, const char* array) const {
    checkNatural(value, named);
    const auto it = root_.find(array);
    const size_t size = it != root_.end() && it->is_array() ? it->size() : 0;
    if (value.get<uint64_t>() >= size)
      refuse(named, fmt::format("is {}, but the file has {} {}", value.get<uint64_t>(), size, array));
  }

  const json& root_;
  const std::string& fileName_;
};

uint64_t naturalAt(const json& object, const char* property) {
  const auto it = object.find(property);
  return it == object.end() ? 0 : it->get<uint64_t>();
}

// EXT_meshopt_compression: a buffer without bytes, which stands for what its views' compressed bytes unfold to.
bool isFallback(const json& buffer) {
  const auto extensions = buffer.find("extensions");
  if (extensions == buffer.end()) return false;
  const auto meshopt = extensions->find("EXT_meshopt_compression");
  return meshopt != extensions->end() && meshopt->value("fallback", false);
}

// glTF 1.0 lists its meshes by name, and so on: of little use to complain of that.
void checkVersion(const json& document, const std::string& fileName) {
  const auto asset = document.find("asset");
  if (asset == document.end() || !asset->is_object()) return;  // told as any other missing property
  const auto version = asset->find("version");
  if (version == asset->end() || !version->is_string() || version->get_ref<const std::string&>().starts_with("2."))
    return;
  throw fileError(fileName, fmt::format("is glTF {}, not 2.0", oneLine(version->get<std::string>())),
                  "export it as glTF 2.0, or convert it");
}

// Each buffer has bytes of its own, and every view lies within its buffer.
void checkBuffers(const json& document, const std::string& fileName, bool isBinary) {
  static const json none = json::array();
  const auto arrayAt = [&](const char* name) -> const json& {
    const auto it = document.find(name);
    return it == document.end() ? none : *it;
  };
  const json& buffers = arrayAt("buffers");
  for (size_t i = 0; i < buffers.size(); ++i) {
    if (naturalAt(buffers[i], "byteLength") == 0)
      throw fileError(fileName, fmt::format("buffer {} has byteLength 0", i), kRemedy);
    const auto uri = buffers[i].find("uri");
    const bool named = uri != buffers[i].end() && !uri->get_ref<const std::string&>().empty();
    if (!named && !(isBinary && i == 0) && !isFallback(buffers[i]))
      throw fileError(fileName, fmt::format("buffer {} has no uri and no bytes in the file", i), kRemedy);
  }
  const json& views = arrayAt("bufferViews");
  for (size_t i = 0; i < views.size(); ++i) {
    // Naturals are at most 2^53, so their sum fits in 64 bits.
    const uint64_t end = naturalAt(views[i], "byteOffset") + naturalAt(views[i], "byteLength");
    const uint64_t buffer = naturalAt(views[i], "buffer"), size = naturalAt(buffers[buffer], "byteLength");
    if (end > size)
      throw fileError(fileName,
                      fmt::format("bufferView {} ends at byte {} of buffer {}, which has {}", i, end, buffer, size),
                      kRemedy);
  }
}

}  // namespace

void checkGltfJson(json& document, const std::string& fileName, bool isBinary) {
  if (!document.is_object()) throw fileError(fileName, "the JSON is not an object", kRemedy);
  checkVersion(document, fileName);
  Checker(document, fileName).checkObject(document, "glTF", "glTF");
  checkBuffers(document, fileName, isBinary);
}

}  // namespace gnomon
