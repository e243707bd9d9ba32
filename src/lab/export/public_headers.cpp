#include "lab/export/public_headers.h"

#include "lab/export/print_code.h"
#include "lab/export/simplify.h"
#include "lab/export/visibility_source.h"

#include "shared/shade.glsl"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

using code::Decl;
using code::Expr;
using code::Program;
using code::Stmt;

struct Header {
  const char* name;
  std::vector<const char*> files;     // whose declarations it has
  std::vector<const char*> comments;  // what it is
};

// Each includes those before it.
const std::vector<Header>& headers() {
  static const std::vector<Header> all = {
      {"map.glsl",
       {"shared/geometry.glsl", "shared/light_frame.glsl", "shared/map.glsl", "shared/cube_map.glsl",
        "shared/planar_map.glsl", "shared/paraboloid_map.glsl"},
       {"Shadow maps of every kind as functions: where a point falls, the light ray through a texel, the depth it "
        "stores.",
        "You define gnomonMapSlice(), which the planar maps ask for their matrices."}},
      {"filter.glsl", {"shared/filter.glsl"}, {"Percentage-closer filters."}},
      {"fetch.glsl",
       {"shared/linked_mesh.glsl", "shared/triangle_ids.glsl", "shared/bias_params.glsl", "shared/channels.glsl",
        "shared/lookup_tables.glsl", "shadow/unbound_visibility.glsl"},
       {"What a map's texels hold, and how it is fetched: you define the functions that are only declared here, those "
        "that",
        "your biases ask for. `source` is GnomonShadowMap::source, a number of yours that says which map is meant."}},
      {"bias.glsl", {"shared/bias.glsl", "shared/bias/"}, {"The biases that look at one texel."}},
      {"surface_bias.glsl",
       {"shared/ray_triangle.glsl", "shared/sheet_walk.glsl", "shared/bias/two_plane.glsl",
        "shared/bias/priority_buffer.glsl", "shared/bias/witness.glsl", "shared/surface_bias.glsl"},
       {"The biases that know surfaces: two-plane, witness, the priority buffers."}},
      {"visibility.glsl",
       {"shadow/fetch_tap.glsl", "shadow/surface_visibility.glsl", "shadow/map_visibility.glsl"},
       {"All of it: how much of a light reaches a receiver, by any map, bias and filter."}},
  };
  return all;
}

// The last header with a file of this name, or with its folder.
size_t headerOf(const Decl& decl) {
  if (decl.name == "receiverAt") return headers().size() - 1;
  std::optional<size_t> folder;
  for (size_t i = 0; i < headers().size(); ++i)
    for (const char* file : headers()[i].files) {
      if (decl.file == file) return i;
      if (std::string_view(file).ends_with('/') && decl.file.starts_with(file)) folder = i;
    }
  return folder.value_or(headers().size());
}

// What the pass has as constants and globals, as members of one argument.
Decl lookupStruct() {
  Decl decl;
  decl.kind = Decl::Kind::Struct;
  decl.file = "shadow/fetch_tap.glsl";
  decl.name = "Lookup";
  decl.comments = {
      " How a map is looked up. Constants are worth it: a compiler then leaves the other biases and filters out."};
  const auto add = [&](const char* type, const char* name, const char* says) {
    decl.members.push_back(code::memberDecl(type, name, "", says));
  };
  add("int", "method", "kGnomonBias*");
  add("BiasParams", "bias", "its parameters");
  add("int", "channels", "kGnomonChannel* bits: what the bias reads of a texel");
  add("int", "filterKind", "kGnomonShadowFilter*");
  add("int", "tapCount", "of the filter: 1, 4 (bilinear), 16 (jitter4x4)");
  add("FilterParams", "filterParams", "its parameters");
  // Of the biases that know surfaces.
  add("int", "witnessReach", "texels a side that witness asks: 2 or 4");
  add("float", "endMargin", "metres: 8 ulps of the scene's largest coordinate");
  add("int", "instanced", "0: every mesh stands in the world, once");
  add("uint", "idShift", "of instanced meshes: a chunk of ids has 2^this triangles");
  add("int", "masked", "1: some material has holes (gnomonIsMeshHole)");
  return decl;
}

bool hasParam(const Decl& decl, const char* type) {
  return std::ranges::any_of(decl.params, [&](const code::Param& param) { return param.type == type; });
}

Expr member(const char* object, const char* name) {
  Expr expr;
  expr.kind = Expr::Kind::Member;
  expr.text = name;
  expr.kids = {code::atom(object)};
  return expr;
}

// Fetches and matrices by the map's number.
void askBySource(Program& program) {
  Decl slice;
  slice.file = "shared/map.glsl";
  slice.name = "mapSlice";
  slice.type = "MapSlice";
  slice.comments = {" Yours: the matrices of a slice of a planar map (spot, directional, cascades)."};
  slice.params = {{.qualifier = "", .type = "int", .name = "source"},
                  {.qualifier = "", .type = "int", .name = "slice"}};
  for (Decl& decl : program.decls) {
    const bool isFetch = decl.name.starts_with("fetch") && !decl.hasBody && decl.kind == Decl::Kind::Function;
    if (isFetch) decl.params.insert(decl.params.begin(), {.qualifier = "", .type = "int", .name = "source"});
    const char* object = hasParam(decl, "ShadowMap") ? "map" : "tables";
    code::eachExpr(decl, [&](Expr& expr) {
      if (expr.kind == Expr::Kind::Index && expr.kids[0].kind == Expr::Kind::Member &&
          expr.kids[0].text == "mapSlices") {
        const Expr place = expr.kids[1];
        expr = code::atom("mapSlice");
        expr.kind = Expr::Kind::Call;
        expr.kids = {member(object, "source"), place};
      }
      const Decl* called =
          expr.kind == Expr::Kind::Call && expr.text.starts_with("fetch") ? program.find(expr.text) : nullptr;
      if (called != nullptr && !called->hasBody) expr.kids.insert(expr.kids.begin(), member(object, "source"));
    });
  }
  const auto after = std::ranges::find_if(program.decls, [](const Decl& decl) { return decl.name == "MapSlice"; });
  program.decls.insert(after + 1, slice);
}

// A shadow volume is none of these maps, and a user's bias is his.
void leaveOutOthers(Program& program) {
  for (Decl& decl : program.decls)
    code::eachStmt(decl.body, [](Stmt& stmt) {
      std::erase_if(stmt.cases, [](const Stmt::Case& one) {
        return std::ranges::any_of(
            one.labels, [](const Expr& label) { return label.isAtom("kMapEpipolar") || label.isAtom("kBiasUser"); });
      });
    });
  std::erase_if(program.decls,
                [](const Decl& decl) { return decl.name == "kMapEpipolar" || decl.name == "kBiasUser"; });
}

void fillTables(Program& program) {
  Decl& fill = *program.find("lookupTables");
  Stmt stmt;
  Expr assignment;
  assignment.kind = Expr::Kind::Binary;
  assignment.text = "=";
  assignment.kids = {member("tables", "source"), member("map", "source")};
  stmt.expr = assignment;
  fill.body.insert(fill.body.end() - 1, stmt);
  program.find("ShadowMap")
      ->members.push_back(
          code::memberDecl("float", "positional", "", "1: the light is a point; 0: it shines along -z of the frame"));
}

Program publicProgram() {
  Program program = code::readVisibility({});
  leaveOutOthers(program);
  askBySource(program);
  fillTables(program);
  code::Known known;
  known.values = {{"kDiagnose", 0}, {"kStage", glsl::kStageWhole}, {"known", 1}, {"filterKnown", 1}};
  known.replacements = {{"kMethod", "lookup.method"},
                        {"kFilter", "lookup.filterKind"},
                        {"kTapCount", "lookup.tapCount"},
                        {"kChannels", "lookup.channels"},
                        {"kInstanced", "lookup.instanced"},
                        {"kMaskedScene", "lookup.masked"},
                        {"kWitnessReach", "lookup.witnessReach"},
                        {"endMargin", "lookup.endMargin"},
                        {"idShift", "lookup.idShift"},
                        {"shade.bias", "lookup.bias"},
                        {"shade.positional", "map.positional"},
                        {"filterParams", "lookup.filterParams"},
                        {"lightFrame", "map.frame"}};
  known.unread = {"pixelDiagnosis", "known", "filterKnown"};
  const std::set<std::string> internal = {"tallied",
                                          "mapDrawnNumbers",
                                          "mapMoreDrawnNumbers",
                                          "paraboloidDrawnNumbers",
                                          "paraboloidDrawnRay",
                                          "paraboloidDrawnDepth",
                                          "WalkTally",
                                          "kernelOffset",
                                          "tentPoint",
                                          "kKernelSamples",
                                          "userLit",
                                          "kUserOffset",
                                          "ParaboloidDrawnRay",
                                          "askingOf",
                                          "kWalkEndCount",
                                          "kernelSamples"};
  for (const Decl& decl : program.decls) {
    const bool binding = decl.name.starts_with("kBind") || decl.name.starts_with("kPass");
    const bool replaced = known.replacements.contains(decl.name) || known.values.contains(decl.name);
    if (headerOf(decl) < headers().size() && !internal.contains(decl.name) && !binding && !replaced)
      known.roots.push_back(decl.name);
  }
  code::simplify(program, known);
  std::erase_if(program.decls, [&](const Decl& decl) { return known.replacements.contains(decl.name); });
  std::set<std::string> users;
  for (Decl& decl : program.decls)
    code::eachExpr(decl.body, [&](Expr& expr) {
      if (expr.isAtom("lookup")) users.insert(decl.name);
    });
  code::passDown(program, users, {.qualifier = "", .type = "Lookup", .name = "lookup"});
  const auto tap =
      std::ranges::find_if(program.decls, [](const Decl& decl) { return headerOf(decl) == headers().size() - 1; });
  program.decls.insert(tap, lookupStruct());
  return program;
}

}  // namespace

std::map<std::string, std::string> publicHeaders() {
  const Program program = publicProgram();
  code::PrintOptions print;
  print.names = code::prefixedNames(program);
  print.names["receiverVisibility"] = "gnomonVisibility";
  print.withoutHead = {"shared/channels.glsl",  "shared/lookup_tables.glsl",  "shared/map.glsl",
                       "shared/bias.glsl",      "shared/surface_bias.glsl",   "shadow/unbound_visibility.glsl",
                       "shadow/fetch_tap.glsl", "shadow/map_visibility.glsl", "shadow/surface_visibility.glsl"};
  std::map<std::string, std::string> texts;
  for (size_t i = 0; i < headers().size(); ++i) {
    const Header& header = headers()[i];
    std::string guard = std::string("GNOMON_GLSL_") + header.name;
    for (char& c : guard) c = c == '.' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string text = fmt::format("#ifndef {0}\n#define {0}\n", guard);
    for (const char* line : header.comments) text += fmt::format("// {}\n", line);
    text += "// Made from Gnomon's own shaders by `gnomon export --headers`; MIT licence.\n";
    if (i > 0) text += "\n";
    for (size_t before = 0; before < i; ++before)
      text += fmt::format("#include \"gnomon/glsl/{}\"\n", headers()[before].name);
    Program part;
    part.heads = program.heads;
    for (const Decl& decl : program.decls)
      if (headerOf(decl) == i) part.decls.push_back(decl);
    text += code::printProgram(part, print) + "\n#endif\n";
    texts[header.name] = text;
  }
  return texts;
}

}  // namespace gnomon
