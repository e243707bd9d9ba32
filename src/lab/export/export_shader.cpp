#include "lab/export/export_shader.h"

#include "base/error.h"
#include "base/suggest.h"
#include "lab/export/exported_tables.h"
#include "lab/export/refuse_user_code.h"
#include "lab/export/simplify.h"
#include "lab/export/visibility_source.h"
#include "scene/mesh_links.h"
#include "scene/scene.h"
#include "scene/scene_buffers.h"

#include "shared/filter.glsl"
#include "shared/map.glsl"
#include "shared/shade.glsl"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

using code::Decl;
using code::Expr;
using code::Language;
using code::Program;
using code::Stmt;
using code::Table;

constexpr float kUnknownDiagonal = 10.0f;  // metres, of a scene that nobody named

std::string number(float value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + "f";
}

std::string title(Language language) {
  switch (language) {
    case Language::Glsl:
      return "GLSL (Vulkan, or OpenGL 4.3)";
    case Language::GlslEs:
      return "GLSL ES 3.00 (WebGL 2, OpenGL ES 3)";
    case Language::Hlsl:
      return "HLSL (shader model 5)";
    case Language::Msl:
      return "Metal shading language 2";
  }
  return {};
}

// `params.knobs[kOffset]` becomes kOffset, and the number of its place the knob's value.
void bakeKnobs(Program& program, const ExportChoice& choice) {
  std::map<std::string, size_t> places;
  for (Decl& decl : program.decls)
    code::eachExpr(decl, [&](Expr& expr) {
      if (expr.kind != Expr::Kind::Index || expr.kids[0].kind != Expr::Kind::Member || expr.kids[0].text != "knobs")
        return;
      const Decl* place = program.find(expr.kids[1].text);
      if (place == nullptr) return;
      const std::string name = place->name;
      if (!places.contains(name)) places[name] = std::stoul(place->value->text);
      expr = code::atom(name);
    });
  for (const auto& [name, place] : places) {
    Decl& decl = *program.find(name);
    const bool ofFilter = decl.file == "shared/filter.glsl";
    const std::vector<Knob>& knobs = ofFilter ? choice.filter->knobs : knobsOf(*choice.bias);
    if (place >= knobs.size()) continue;  // of another bias, and about to go
    const Knob& knob = knobs[place];
    decl.type = "float";
    decl.file = "constants";
    const std::string unit = *unitName(knob.unit) != '\0' ? std::string(unitName(knob.unit)) + ": " : "";
    decl.trailing = fmt::format(" {}{}", unit, knob.sentence);
    decl.comments.clear();
    if (const auto given = choice.knobs.find(&knob); given != choice.knobs.end()) {
      decl.value = code::atom(number(given->second));
    } else if (!knob.defaultOfSceneScale) {
      decl.value = code::atom(number(knob.defaultValue));
    } else {
      Expr product;
      product.kind = Expr::Kind::Binary;
      product.text = "*";
      product.kids = {code::atom(number(knob.defaultValue)), code::atom("kSceneScale")};
      decl.value = product;
    }
  }
}

// The slices' matrices become members of the map: one, or an array of them.
void bakeSlices(Program& program, const ExportedMap& map) {
  for (Decl& decl : program.decls)
    code::eachExpr(decl, [&](Expr& expr) {
      if (expr.kind != Expr::Kind::Index || expr.kids[0].kind != Expr::Kind::Member || expr.kids[0].text != "mapSlices")
        return;
      if (map.sliceCount == 1) {
        expr = Expr(expr.kids[0]);
        expr.text = "projection";
      } else {
        expr.kids[0].text = "projections";
      }
    });
  Decl& shadowMap = *program.find("ShadowMap");
  if (map.sliceCount == 1)
    shadowMap.members.push_back(code::memberDecl("MapSlice", "projection", "", "from and to the frame `frame`"));
  else
    shadowMap.members.push_back(
        code::memberDecl("MapSlice", "projections", std::to_string(map.sliceCount), "of each slice, the finest first"));
}

code::Known knownOf(const ExportChoice& choice, bool instanced, bool masked) {
  code::Known known;
  const bool filtered = choice.filter->id != glsl::kShadowFilterNone;
  const int reach = choice.choices.witnessReach;
  known.values = {{"kMethod", choice.bias->id},
                  {"kMapKind", choice.map.kind},
                  {"kDiagnose", 0},
                  {"kMaskedScene", masked},
                  {"kInstanced", instanced},
                  {"kStage", glsl::kStageWhole},
                  {"kWitnessReach", reach},
                  {"kChannels", choice.bias->channels},
                  {"kFilter", choice.filter->id},
                  {"params.epsilonAt", choice.choices.epsilonAt},
                  {"params.priorityId", choice.choices.priorityId},
                  {"priorityId", choice.choices.priorityId},
                  {"reach", reach},
                  {"asking.reach", reach},
                  {"asking.isTap", filtered},
                  {"asking.crossesEdge", 1},
                  {"tables.positional", choice.map.positional},
                  {"tables.instanced", instanced},
                  {"tables.masked", masked},
                  {"kind", choice.filter->id},
                  {"known", 1},
                  {"filterKnown", 1}};
  const auto isRead = [&](int channel) { return (choice.bias->channels & channel) != 0; };
  if (!isRead(glsl::kChannelDepth)) known.values["tap.z1"] = 1;
  if (!isRead(glsl::kChannelBackDepth)) known.values["tap.zBack"] = 1;
  known.replacements = {
      {"map.width", "kMapSide"},        {"map.height", "kMapSide"},        {"tables.mapWidth", "kMapSide"},
      {"tables.mapHeight", "kMapSide"}, {"map.sceneScale", "kSceneScale"}, {"tables.endMargin", "kEndMargin"},
      {"tables.idShift", "kIdShift"},   {"lightFrame", "map.frame"},       {"map.sliceCount", "kSliceCount"}};
  known.unread = {"known", "filterKnown", "pixelDiagnosis"};
  known.roots = {"receiverAt", "receiverVisibility"};
  known.userFile = kUserBiasFile;
  return known;
}

void dropUnmentioned(Program& program, const char* function) {
  Decl& decl = *program.find(function);
  std::erase_if(decl.params, [&](const code::Param& param) {
    bool mentioned = false;
    code::eachExpr(decl.body, [&](Expr& expr) { mentioned = mentioned || expr.isAtom(param.name); });
    return !mentioned;
  });
}

void addConstants(Program& program, const ExportChoice& choice, const ExportedScene& facts, bool instanced) {
  const std::string scene =
      choice.scene ? fmt::format("the diagonal of `{}`", facts.name) : "your scene's diagonal: 10 m stand for it";
  std::vector<Decl> constants = {
      code::constantDecl("int", "kMapSide", std::to_string(choice.map.side), "texels, of a slice's side"),
      code::constantDecl("int", "kSliceCount", std::to_string(choice.map.sliceCount), "of the map"),
      code::constantDecl("float", "kSceneScale", number(facts.diagonal), "m: " + scene),
      code::constantDecl("float", "kEndMargin", number(facts.endMargin),
                         choice.scene ? fmt::format("m: 8 ulps of the largest coordinate of `{}`", facts.name)
                                      : "m: 8 ulps of your scene's largest coordinate, which is 10 m here"),
  };
  if (instanced)
    constants.push_back(code::constantDecl("uint", "kIdShift", std::to_string(facts.idShift) + "u",
                                           "a chunk of ids has 2^this triangles"));
  program.decls.insert(program.decls.begin(), constants.begin(), constants.end());
}

// Knobs behind the constants they are made of.
void gatherConstants(Program& program) {
  std::stable_partition(program.decls.begin(), program.decls.end(),
                        [](const Decl& decl) { return decl.file == "constants"; });
}

// Each behind what it names: a user's functions may be declared first and defined later. What is in order stays.
class InOrder {
 public:
  explicit InOrder(Program& program) : program_(program) {
    std::vector<Decl> all;
    all.swap(program_.decls);
    for (Decl& decl : all) waiting_.emplace(decl.name, &decl);
    for (const Decl& decl : all) place(decl.name);
  }

 private:
  void place(const std::string& name) {
    const auto found = waiting_.find(name);
    if (found == waiting_.end()) return;
    Decl& decl = *found->second;
    waiting_.erase(found);
    place(decl.type);
    for (const code::Param& param : decl.params) place(param.type);
    for (std::vector<Stmt>* stmts : {&decl.members, &decl.body})
      code::eachStmt(*stmts, [&](const Stmt& stmt) { place(stmt.type); });
    code::eachExpr(decl, [&](const Expr& expr) {
      if (expr.kind == Expr::Kind::Atom || expr.kind == Expr::Kind::Call) place(expr.text);
    });
    program_.decls.push_back(std::move(decl));
  }

  Program& program_;
  std::map<std::string, Decl*> waiting_;
};

bool hasParam(const Program& program, const char* function, const char* name) {
  return std::ranges::any_of(program.find(function)->params,
                             [&](const code::Param& param) { return param.name == name; });
}

// What a caller writes between the parentheses: the parameters that are left, by the names that the head explains.
std::string argumentsOf(const Program& program, const char* function) {
  static const std::map<std::string, std::string> explained = {
      {"posW", "positionW"}, {"normalW", "normalW"}, {"id", "triangleId"}};
  std::string arguments;
  for (const code::Param& param : program.find(function)->params) {
    const auto found = explained.find(param.name);
    arguments += (arguments.empty() ? "" : ", ") + (found == explained.end() ? param.name : found->second);
  }
  return arguments;
}

// What a caller fills the map's members with.
std::vector<std::string> mapLines(const ExportChoice& choice) {
  switch (choice.map.kind) {
    case glsl::kMapCube:
      return {
          "Slices 0 to 5 are +X, -X, +Y, -Y, +Z, -Z as Vulkan, Direct3D, OpenGL and Metal orient a cube map's faces,",
          "drawn around the light along the world's axes with 90 degrees, zNear to zFar metres along the face's axis,",
          "and store the rasterizer's own depth: (clipDepth.x m + clipDepth.y) / m at m metres along the axis, with",
          "clipDepth.x = zFar / (zFar - zNear) and clipDepth.y = -zNear clipDepth.x."};
    case glsl::kMapCubeRadial:
      return {
          "Slices 0 to 5 are +X, -X, +Y, -Y, +Z, -Z as Vulkan, Direct3D, OpenGL and Metal orient a cube map's faces,",
          "drawn around the light along the world's axes with 90 degrees, and store (distance - zNear) / (zFar - "
          "zNear),",
          "the distance from the light in metres."};
    case glsl::kMapParaboloid:
      return {
          "Slice 0 looks along -z of the light's frame, slice 1 along +z; a texel at (x, y) of the disc stores what "
          "its",
          "ray sees: (distance - zNear) / (zFar - zNear), metres from the light."};
    default:
      return {
          "clipFromLight: from the light's frame to clip space, z from 0 to w, y down: uv = 0.5 clip.xy / clip.w + "
          "0.5;",
          "lightFromClip is its inverse. Depth is clip.z / clip.w."};
  }
}

std::string headerText(const ExportChoice& choice, const Program& program, const std::vector<const Table*>& used,
                       const ExportedScene& facts) {
  const Language language = choice.language;
  std::vector<std::string> lines;
  const auto say = [&](const std::string& line) { lines.push_back(line.empty() ? "" : " " + line); };
  say(fmt::format("Shadow by a {} map, bias `{}`, filter `{}`: {}.", choice.map.name, choice.bias->name,
                  choice.filter->name, title(language)));
  say(fmt::format("Bias: {}", choice.bias->sentence));
  say(fmt::format("Made by `{}`; MIT licence.", choice.command));
  say("");
  const bool usesId = hasParam(program, "receiverAt", "id");
  say(fmt::format("  GnomonReceiver receiver = gnomonReceiverAt({});", argumentsOf(program, "receiverAt")));
  say(fmt::format("  float lit = gnomonVisibility({});", argumentsOf(program, "receiverVisibility")));
  say("");
  if (hasParam(program, "receiverAt", "normalW")) {
    say("positionW lies on the surface, metres; normalW is its triangle's unit normal, turned to the light's side (no "
        "bump or");
    say("smooth normal: cross(dFdx(positionW), dFdy(positionW)) will do). What faces away from the light is dark "
        "without a map.");
  } else {
    say("positionW lies on the surface, metres. What faces away from the light is dark without a map.");
  }
  if (choice.map.kind == glsl::kMapCube || choice.map.kind == glsl::kMapCubeRadial)
    say("frame: the light's place, and the world's axes.");
  else if (choice.map.positional)
    say("frame: the light's place, and its axes; it looks along -backW.");
  else
    say("frame: a point near the scene, and the light's axes; it shines along -backW.");
  if (usesId) say("triangleId: 1 + the place of the receiver's triangle among all, as the map's ids name it.");
  if (hasParam(program, "receiverVisibility", "pixel")) say("pixel: of the picture; it varies the jitter.");
  say("");
  say(fmt::format("The map, {} slice{} of {} x {} texels:", choice.map.sliceCount,
                  choice.map.sliceCount == 1 ? "" : "s", choice.map.side, choice.map.side));
  for (const std::string& line : mapLines(choice)) say("  " + line);
  say("");
  say("Textures and buffers, read texel by texel, no filtering:");
  for (size_t i = 0; i < used.size(); ++i) {
    const Table& table = *used[i];
    const char* form = table.isMap                    ? "array texture"
                       : language == Language::GlslEs ? "texture, 2048 rows a line"
                                                      : "buffer";
    const std::string format = table.isDepthFormat
                                   ? "32-bit float (depth, or R32F)"
                                   : fmt::format("{}{}",
                                                 table.components == 1   ? "R"
                                                 : table.components == 2 ? "RG"
                                                                         : "RGBA",
                                                 std::string(table.component) == "uint" ? "32UI" : "32F");
    say(fmt::format(
        "  {} {}: {}, {}", language == Language::Msl ? std::string("GnomonTextures::") + table.member : table.name,
        language == Language::Msl || language == Language::GlslEs ? "" : fmt::format("(binding {})", i), form, format));
    say(fmt::format("    {}.", table.holds));
  }
  if (program.find("isMeshHole") != nullptr) {
    say("");
    say(fmt::format("`{}` has alpha masks: gnomonIsMeshHole() below is yours to fill in.", facts.name));
  }
  const bool exact = choice.bias->id == glsl::kBiasWitness || choice.bias->id == glsl::kBiasTwoPlane;
  if (exact && language == Language::GlslEs) {
    say("");
    say("GLSL ES 3.00 has no `precise`: a compiler that contracts a * b + c costs the walk over the mesh its last "
        "digits.");
  }
  if (language == Language::Msl) {
    say("");
    say("Compile with -fno-fast-math. Not compiled by Apple's compiler: Gnomon's tests parse it as C++.");
  }
  return code::commentLines(lines);
}

}  // namespace

ExportedScene exportedScene(const Scene& scene) {
  ExportedScene facts;
  facts.name = scene.name;
  facts.diagonal = computeBounds(scene).diagonal();
  facts.endMargin = receiverMargin(computeBounds(scene));
  facts.masked = std::ranges::any_of(scene.materials,
                                     [](const Material& material) { return material.alphaMode == AlphaMode::Mask; });
  // As createSceneBuffers() numbers them.
  std::vector<uint32_t> meshBegins, triangleCounts, firstTriangles;
  uint32_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    meshBegins.push_back(triangles);
    triangles += static_cast<uint32_t>(mesh.indices.size() / 3);
  }
  std::set<int> placed;
  for (const Instance& instance : scene.instances) {
    const auto mesh = static_cast<size_t>(instance.mesh);
    triangleCounts.push_back(static_cast<uint32_t>(scene.meshes[mesh].indices.size() / 3));
    firstTriangles.push_back(meshBegins[mesh]);
    if (!placed.insert(instance.mesh).second || instance.worldFromMesh != glm::mat4(1.0f)) facts.instanced = true;
  }
  facts.idShift = numberTriangles(triangleCounts, firstTriangles, facts.instanced).shift;
  return facts;
}

ExportedMap exportedMap(const std::string& name, bool radial, int cascades) {
  if (name == "cube") return {.name = "cube", .kind = radial ? glsl::kMapCubeRadial : glsl::kMapCube, .sliceCount = 6};
  if (name == "paraboloid") return {.name = "dual paraboloid", .kind = glsl::kMapParaboloid, .sliceCount = 2};
  if (name == "spot") return {.name = "spot", .kind = glsl::kMapPlanar, .sliceCount = 1};
  if (name == "directional")
    return {.name = "directional", .kind = glsl::kMapPlanar, .sliceCount = cascades, .positional = false};
  if (name == "vsv")
    throw UsageError(
        "--map vsv: a shadow volume is bits that compute passes fill, which one function cannot hold; export one of "
        "cube, paraboloid, spot, directional");
  throw UsageError(
      fmt::format("--map {}: no such map; {}", name, chooseFrom(name, "cube, paraboloid, spot, directional")));
}

namespace {

ExportedScene factsOf(const ExportChoice& choice) {
  ExportedScene facts;
  if (choice.scene) {
    facts = *choice.scene;
  } else {
    facts.diagonal = kUnknownDiagonal;
    facts.endMargin =
        8.0f * (std::nextafter(kUnknownDiagonal, std::numeric_limits<float>::infinity()) - kUnknownDiagonal);
  }
  return facts;
}

// What exported code declares beside the pass's own.
std::set<std::string> takenNames() {
  std::set<std::string> names = {"gnomonVisibility",  "gnomonFindLsb",     "GnomonTextures",   "kGnomonMapSide",
                                 "kGnomonSliceCount", "kGnomonSceneScale", "kGnomonEndMargin", "kGnomonIdShift"};
  for (const Table& table : code::tables()) names.insert(table.name);
  return names;
}

// All that is left of the pass, in no language yet.
Program leftOf(const ExportChoice& choice, const ExportedScene& facts) {
  const std::map<std::string, std::string> aliases = {{"GNOMON_BIAS_METHOD", "kMethod"},
                                                      {"GNOMON_MAP_KIND", "kMapKind"}};
  Program program = choice.bias->user != nullptr ? code::readVisibilityWith(*choice.bias->user, aliases)
                                                 : code::readVisibility(aliases);
  const code::Known known = knownOf(choice, facts.instanced, facts.masked);
  if (choice.bias->user != nullptr)
    code::refuseUserCode(program, *choice.bias->user, known, choice.language, takenNames());
  bakeKnobs(program, choice);
  bakeSlices(program, choice.map);
  addConstants(program, choice, facts, facts.instanced);
  Decl& tapCount = *program.find("kTapCount");
  tapCount.value = code::atom(std::to_string(choice.filter->tapCount));
  tapCount.file = "constants";
  code::simplify(program, known);
  if (choice.bias->user != nullptr) code::refuseLeftParams(program, *choice.bias->user);
  dropUnmentioned(program, "receiverAt");
  dropUnmentioned(program, "receiverVisibility");
  // A bias that compares numbers of triangles reads nothing of the map.
  if (program.find("ShadowMap")->members.empty()) {
    std::erase_if(program.decls, [](const Decl& decl) { return decl.name == "ShadowMap"; });
    std::erase_if(program.find("receiverVisibility")->params,
                  [](const code::Param& param) { return param.type == "ShadowMap"; });
  }
  gatherConstants(program);
  InOrder{program};
  return program;
}

ExportedShader printed(const ExportChoice& choice, const ExportedScene& facts, Program program) {
  code::PrintOptions print;
  print.language = choice.language;
  print.names = code::prefixedNames(program);
  print.names["receiverVisibility"] = "gnomonVisibility";
  if (choice.filter->id == glsl::kShadowFilterNone) print.withoutHead.insert("shared/filter.glsl");
  print.withoutHead.insert({"shared/map.glsl", "shared/bias.glsl", "shared/channels.glsl", "shared/lookup_tables.glsl",
                            "shared/lang.glsl", "shared/shade.glsl", "shared/scene.glsl", "shared/bias_params.glsl",
                            "shared/surface_bias.glsl", "shadow/unbound_visibility.glsl", "shadow/map_visibility.glsl",
                            "shadow/surface_visibility.glsl", "shadow/fetch_tap.glsl", "shadow/map_constants.glsl"});
  ExportedShader exported;
  std::vector<const Table*> used;
  for (const Table& table : code::tables()) {
    const Decl* decl = program.find(table.function);
    if (decl == nullptr) continue;
    exported.resources.push_back({.name = table.name, .binding = static_cast<int>(used.size()), .holds = table.holds});
    print.definitions[decl->name] = code::definition(choice.language, table, print, *decl, program);
    used.push_back(&table);
  }
  if (const Decl* hole = program.find("isMeshHole")) {
    const char* inlined = choice.language == Language::Msl ? "inline " : "";
    print.definitions[hole->name] = fmt::format(
        "// Whether the alpha mask has a hole where a triangle's corners weigh so much. Yours to fill in.\n"
        "{}bool gnomonIsMeshHole(uint triangle_, uint instance, {} weights) {{\n  return false;\n}}\n",
        inlined, code::nameIn(choice.language, "vec3"));
  }
  // Metal has no globals: what reads textures takes them, and so does what calls it.
  if (choice.language == Language::Msl) {
    std::set<std::string> readers;
    for (const Table* table : used) readers.insert(table->function);
    code::passDown(program, readers, {.type = "GnomonTextures", .name = "textures"});
  }

  exported.text = headerText(choice, program, used, facts) + "\n";
  if (choice.language == Language::GlslEs) {
    exported.text += "precision highp float;\nprecision highp int;\n\n";
  } else if (choice.language == Language::Msl) {
    exported.text += "#include <metal_stdlib>\nusing namespace metal;\n\nstruct GnomonTextures {\n";
  }
  for (size_t i = 0; i < used.size(); ++i)
    exported.text += code::declaration(choice.language, *used[i], static_cast<int>(i));
  if (choice.language == Language::Msl) exported.text += "};\n";
  std::string code = code::printProgram(program, print);
  if (choice.language == Language::GlslEs && code.find("gnomonFindLsb(") != std::string::npos)
    exported.text +=
        "\n// findLSB of later versions.\nint gnomonFindLsb(uint bits) {\n  int place = bits == 0u ? -1 : 0;\n  while "
        "(place >= 0 && ((bits >> uint(place)) & 1u) == 0u) ++place;\n  return place;\n}\n";
  if (choice.language == Language::Msl && code.find("gnomonFindLsb(") != std::string::npos)
    exported.text +=
        "\n// Of the lowest bit; -1 where there is none.\n"
        "inline int gnomonFindLsb(uint bits) { return bits == 0u ? -1 : int(ctz(bits)); }\n";
  exported.text += code;
  return exported;
}

}  // namespace

ExportedShader exportShader(const ExportChoice& choice) {
  const ExportedScene facts = factsOf(choice);
  return printed(choice, facts, leftOf(choice, facts));
}

std::vector<ExportedShader> exportShaders(ExportChoice choice) {
  const ExportedScene facts = factsOf(choice);
  const Program program = leftOf(choice, facts);
  std::vector<ExportedShader> all;
  for (size_t i = 0; i < code::languageNames().size(); ++i) {
    choice.language = static_cast<Language>(i);
    all.push_back(printed(choice, facts, program));
  }
  return all;
}

}  // namespace gnomon
