#include "lab/export/exported_tables.h"

#include <map>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

bool isC(Language language) {
  return language == Language::Hlsl || language == Language::Msl;
}

std::string vectorType(Language language, const Table& table) {
  if (isC(language))
    return table.components == 1 ? table.component : fmt::format("{}{}", table.component, table.components);
  const char* letter = std::string(table.component) == "uint" ? "u" : "";
  return fmt::format("{}vec4", letter);
}

// How its row is read; of GLSL ES, which has no buffers, from a texture with 2048 rows a line.
std::string readRow(Language language, const Table& table, const std::string& row) {
  switch (language) {
    case Language::Glsl:
      return fmt::format("texelFetch({}, int({}))", table.name, row);
    case Language::GlslEs:
      return fmt::format("texelFetch({}, ivec2(int({}) & 2047, int({}) >> 11), 0)", table.name, row, row);
    case Language::Hlsl:
      return fmt::format("{}[{}]", table.name, row);
    case Language::Msl:
      return fmt::format("textures.{}[{}]", table.member, row);
  }
  return {};
}

}  // namespace

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      {"fetchDepth", "gnomonDepth", "depth", true, true, "float", 1,
       "the nearest depth, 0 at the near end, 1 at the far end and where nothing was drawn"},
      {"fetchSecondDepth", "gnomonSecondDepth", "secondDepth", true, false, "float", 1,
       "the nearest depth behind that one; 1 where there is none"},
      {"fetchBackDepth", "gnomonBackDepth", "backDepth", true, true, "float", 1,
       "the nearest depth of back faces: closed meshes drawn with front faces culled, all others as they are"},
      {"fetchId", "gnomonIds", "ids", true, false, "uint", 1,
       "the number of the triangle that the nearest depth is of, 1 + its place among all; 0 where nothing was drawn"},
      {"fetchSecondId", "gnomonSecondIds", "secondIds", true, false, "uint", 1, "the same of the second depth"},
      {"meshRow", "gnomonMeshRows", "meshRows", false, false, "uint", 4,
       "three rows a triangle: the bits of a corner's x, y, z, and the link across the edge opposite to it (the "
       "picture at GnomonMeshRow)"},
      {"worldFromMesh", "gnomonInstances", "instances", false, false, "float", 4,
       "four rows an instance: the columns of worldFromMesh"},
      {"idChunkAt", "gnomonIdChunks", "idChunks", false, false, "uint", 2,
       "one row a chunk of ids: its instance, and its first triangle among all"},
      {"triangleFacts", "gnomonTriangleTable", "triangleTable", false, false, "uint", 2,
       "one row a triangle: its instance, and its connected surface"},
  };
  return all;
}

std::string declaration(Language language, const Table& table, int binding) {
  const std::string u = std::string(table.component) == "uint" ? "u" : "";
  const std::string type = vectorType(language, table);
  switch (language) {
    case Language::Glsl:
      return fmt::format("layout(binding = {}) uniform {}{} {};\n", binding, u,
                         table.isMap ? "sampler2DArray" : "samplerBuffer", table.name);
    case Language::GlslEs:
      return fmt::format("uniform highp {}{} {};\n", u, table.isMap ? "sampler2DArray" : "sampler2D", table.name);
    case Language::Hlsl:
      return fmt::format("{}<{}> {} : register(t{});\n", table.isMap ? "Texture2DArray" : "Buffer", type, table.name,
                         binding);
    case Language::Msl:
      if (!table.isMap) return fmt::format("  const device {}* {};\n", type, table.member);
      return fmt::format("  {}_array<{}> {};\n", table.isDepthFormat ? "depth2d" : "texture2d", table.component,
                         table.member);
  }
  return {};
}

std::string definition(Language language, const Table& table, const PrintOptions& names, const Decl& decl,
                       const Program& program) {
  const auto type = [&](const char* glsl) {
    return names.names.contains(glsl) ? names.names.at(glsl) : nameIn(language, glsl);
  };
  const std::string name = names.names.at(decl.name);
  const std::string end = language == Language::Msl ? ", GnomonTextures textures)" : ")";
  const std::string begin = language == Language::Msl ? "inline " : "";
  if (table.isMap) {
    std::string fetch;
    switch (language) {
      case Language::Glsl:
      case Language::GlslEs:
        fetch = fmt::format("texelFetch({}, ivec3(texel, slice), 0).x", table.name);
        break;
      case Language::Hlsl:
        fetch = fmt::format("{}.Load(int4(texel, slice, 0))", table.name);
        break;
      case Language::Msl:
        fetch =
            fmt::format("textures.{}.read(uint2(texel), uint(slice)){}", table.member, table.isDepthFormat ? "" : ".x");
        break;
    }
    // As the others wrap a long head.
    return wrappedCode(
               fmt::format("{}{} {}(int slice, {} texel{} {{", begin, table.component, name, type("ivec2"), end), 0) +
           "\n  return " + fetch + ";\n}\n";
  }
  const std::string function = decl.name;
  if (function == "worldFromMesh") {
    std::string columns;
    for (int i = 0; i < 4; ++i)
      columns += (i > 0 ? ",\n              " : "") + readRow(language, table, fmt::format("(4u * instance + {}u)", i));
    return fmt::format("{}{} {}(uint instance{} {{\n  return {}({});\n}}\n", begin, type("mat4"), name, end,
                       type("mat4"), columns);
  }
  // A structure of which only what is used is left.
  const std::string result = type(decl.type.c_str());
  std::string text = fmt::format("{}{} {}(uint place{} {{\n  {} row = {};\n  {} found;\n", begin, result, name, end,
                                 type(table.components == 4 || !isC(language) ? "uvec4" : "uvec2"),
                                 readRow(language, table, "place"), result);
  const std::string bits = language == Language::Hlsl  ? "asfloat(row.xyz)"
                           : language == Language::Msl ? "as_type<float3>(row.xyz)"
                                                       : "uintBitsToFloat(row.xyz)";
  const std::map<std::string, std::string> parts = {
      {"corner", bits}, {"link", "row.w"}, {"instance", "row.x"}, {"firstTriangle", "row.y"}, {"sheet", "row.y"}};
  for (const Stmt& member : program.find(decl.type)->members)
    for (const Declarator& part : member.names)
      text += fmt::format("  found.{} = {};\n", part.name, parts.at(part.name));
  return text + "  return found;\n}\n";
}

}  // namespace gnomon::code
