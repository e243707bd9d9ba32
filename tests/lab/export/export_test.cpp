// What `gnomon export` writes: every file is compiled, and gives the very visibility that Gnomon's own pass gives.
#include "lab/export/public_headers.h"
#include "scene/mesh_links.h"
#include "shadow/map_image.h"
#include "shadow/user_bias.h"
#include "tests/base/places.h"
#include "tests/judge/lit_map.h"
#include "tests/lab/export/compile_export.h"
#include "tests/lab/export/what_to_export.h"

#include <regex>

#include <fmt/format.h>

namespace gnomon {
namespace {

using code::Language;
using test::calls;
using test::choiceOf;
using test::compiled;
using test::Kind;
using test::kinds;
using test::kUserHead;
using test::LitMap;
using test::mentions;
using test::metalErrors;

TEST(Export, CompilesForEveryMapBiasAndFilter) {
  std::string metal = "#include <metal_stdlib>\n";
  size_t count = 0;
  for (const Kind& kind : kinds())
    for (const BiasMethod& bias : biasMethods())
      for (const Filter& filter : filters()) {
        const std::vector<ExportedShader> all = exportShaders(choiceOf(kind, bias, filter, Language::Glsl));
        ASSERT_EQ(all.size(), 4u);
        for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl})
          EXPECT_EQ(compiled(language, all[static_cast<size_t>(language)].text), "")
              << kind.label << " " << bias.name << " " << filter.name << " "
              << code::languageNames()[static_cast<size_t>(language)];
        std::string text = all[static_cast<size_t>(Language::Msl)].text;
        const std::string library = "#include <metal_stdlib>\n";
        text.erase(text.find(library), library.size());
        metal += fmt::format("namespace n{} {{\n{}}}\n", count++, text);
      }
  EXPECT_EQ(count, kinds().size() * biasMethods().size() * filters().size());
  EXPECT_EQ(metalErrors(metal), "");
}

std::unique_ptr<const UserBias> sampleBias(const char* name) {
  return loadUserBias(test::inSource(std::string("samples/") + name));
}

// A bias of one's own is a bias as any other.
TEST(Export, CompilesWithAUsersBias) {
  for (const char* file : {"my_bias.glsl", "filament_bias.glsl"})
    for (const Kind& kind : kinds())
      for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl}) {
        const auto user = sampleBias(file);
        const std::string text = exportShader(choiceOf(kind, user->method, filters()[1], language)).text;
        EXPECT_EQ(compiled(language, text), "") << file << " " << kind.label;
        for (const Knob& knob : user->method.knobs)
          EXPECT_TRUE(mentions(text, "kGnomon" + knobConstant(knob.name).substr(1))) << knob.name;
      }
}

// The head's usage lines have the arguments that the functions take.
TEST(Export, ItsHeadSaysHowItIsCalled) {
  for (const BiasMethod& bias : biasMethods())
    for (const Language language : {Language::Glsl, Language::Msl}) {
      const std::string text = exportShader(choiceOf(kinds()[1], bias, filters()[2], language)).text;
      for (const char* function : {"gnomonReceiverAt(", "gnomonVisibility("}) {
        const auto commas = [&](const char* before) {
          const size_t at = text.find(std::string(before) + function);
          const std::string_view call = std::string_view(text).substr(at, text.find(')', at) - at);
          EXPECT_NE(at, std::string::npos) << bias.name;
          return std::count(call.begin(), call.end(), ',');
        };
        EXPECT_EQ(commas("= "), commas(function[6] == 'R' ? "GnomonReceiver " : "float "))
            << bias.name << " " << function;
      }
      EXPECT_EQ(mentions(text, "normalW is its"), mentions(text, " normalW)") || mentions(text, " normalW, "))
          << bias.name;
    }
}

// What Gnomon measures is what glslang takes.
TEST(Export, TheBranchThatIsMeasuredIsExported) {
  for (const char* undefined : {"__VERSION__", "GL_SPIRV", "__cplusplus"}) {
    const auto mine = readUserBias("mine.glsl", fmt::format("{} {{\n#ifdef {}\n  return tap.z1 > 0.75f;\n#else\n  "
                                                            "return tap.z1 > 0.25f;\n#endif\n}}\n",
                                                            kUserHead, undefined));
    const std::string text = exportShader(choiceOf(kinds()[1], mine->method, filters()[0], Language::Glsl)).text;
    EXPECT_TRUE(mentions(text, "0.25f") && !mentions(text, "0.75f")) << undefined;
  }
  const auto user = readUserBias("mine.glsl", fmt::format("#ifdef VULKAN\n{0} {{ return tap.z1 > 0.25f; }}\n#else\n{0} "
                                                          "{{ return tap.z1 > 0.75f; }}\n#endif\n",
                                                          kUserHead));
  const std::string text = exportShader(choiceOf(kinds()[1], user->method, filters()[0], Language::Glsl)).text;
  EXPECT_TRUE(mentions(text, "0.25f"));
  EXPECT_FALSE(mentions(text, "0.75f"));
}

TEST(Export, WordsOfALanguageAreNoNamesThere) {
  std::string chain = "float first = tap.z1;", last = "first";
  for (const char* word : {"matrix",
                           "vector",
                           "string",
                           "device",
                           "constant",
                           "kernel",
                           "vertex",
                           "thread",
                           "compile",
                           "pass",
                           "point",
                           "new",
                           "delete",
                           "private",
                           "operator",
                           "float1",
                           "int2x3",
                           "frac",
                           "lerp",
                           "rsqrt",
                           "asfloat",
                           "asuint",
                           "firstbitlow",
                           "Texture2D",
                           "Texture2DArray",
                           "Buffer",
                           "StructuredBuffer",
                           "RWBuffer",
                           "and",
                           "or",
                           "not",
                           "xor_eq",
                           "bitand",
                           "compl",
                           "wchar_t",
                           "char16_t",
                           "export",
                           "typeid",
                           "as_type",
                           "ctz",
                           "int64_t",
                           "float16_t2",
                           "NAN",
                           "INFINITY",
                           "INT_MAX",
                           "FLT_MAX",
                           "M_PI_F"}) {
    chain += fmt::format(" float {} = {} + 1.0f;", word, last);
    last = word;
  }
  const auto user = readUserBias("mine.glsl", fmt::format("{} {{ {} return {} > 0.5f; }}\n", kUserHead, chain, last));
  const auto textOf = [&](Language language) {
    return exportShader(choiceOf(kinds()[1], user->method, filters()[0], language)).text;
  };
  EXPECT_TRUE(mentions(textOf(Language::Hlsl), "float matrix_ = "));
  EXPECT_TRUE(mentions(textOf(Language::Msl), "float device_ = "));
  EXPECT_TRUE(mentions(textOf(Language::Msl), "float and_ = "));
  EXPECT_TRUE(mentions(textOf(Language::Msl), "float as_type_ = "));
  EXPECT_TRUE(mentions(textOf(Language::Hlsl), "float int64_t_ = "));
  for (const char* word : {"NAN", "INFINITY", "INT_MAX", "FLT_MAX", "M_PI_F"})
    EXPECT_TRUE(mentions(textOf(Language::Msl), fmt::format("float {}_ = ", word)));
  EXPECT_TRUE(mentions(textOf(Language::Glsl), "float matrix = "));
  EXPECT_EQ(compiled(Language::Hlsl, textOf(Language::Hlsl)), "");
}

// Whole, as a reader would paste it; the version and the extension come from the preamble of our shaders.
TEST(Export, TheDocumentationsExampleCompiles) {
  const std::string page = readFile(test::inSource("docs/glsl.md"));
  const size_t begin = page.find("#include \"gnomon/glsl/visibility.glsl\"", page.find("#version 460"));
  gpu::ShaderSource source{"example.comp.glsl",
                           {{"example.comp.glsl", page.substr(begin, page.find("```", begin) - begin)}}};
  for (const auto& [name, text] : publicHeaders()) source.overrides["gnomon/glsl/" + name] = text;
  EXPECT_FALSE(gpu::compileShader(source).empty());
}

// Instances and alpha masks: the tables of a mesh, in every language.
TEST(Export, CompilesWithInstancesAndMasks) {
  ExportedScene facts{
      .name = "a", .diagonal = 3.0f, .endMargin = 1e-6f, .instanced = true, .masked = true, .idShift = 5};
  for (const char* bias : {"priority-buffer", "two-plane", "witness"})
    for (const int priority : {glsl::kPriorityTriangle, glsl::kPriorityInstance, glsl::kPrioritySheet})
      for (const Language language : {Language::Glsl, Language::GlslEs, Language::Hlsl}) {
        ExportChoice choice = choiceOf(kinds()[1], findBias(bias), filters()[0], language);
        choice.scene = facts;
        choice.choices.priorityId = priority;
        choice.choices.witnessReach = 4;
        EXPECT_EQ(compiled(language, exportShader(choice).text), "") << bias;
      }
}

// Names that a renderer has of its own do not meet those of a file.
TEST(Export, EveryNameHasThePrefix) {
  const std::string text = exportShader(choiceOf(kinds()[1], findBias("witness"), filters()[1], Language::Glsl)).text;
  const std::regex declared("(?:^|\n)(?:const )?(?:struct|float|int|uint|bool|[iu]?vec[234]|mat4|Gnomon\\w+) (\\w+)");
  size_t count = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), declared); at != std::sregex_iterator(); ++at, ++count)
    EXPECT_TRUE(std::regex_search((*at)[1].str(), std::regex("^(gnomon|Gnomon|kGnomon)[A-Z]"))) << (*at)[1];
  EXPECT_GT(count, 60u);
  EXPECT_FALSE(mentions(text, "GNOMON_"));
}

class ExportOnTheGpu : public gpu::GpuTest {
 protected:
  // Pixels whose visibility by the exported file is not the bits of that by Gnomon's own pass; and how many are in
  // shadow, so that the claim is about something.
  struct Compared {
    size_t different = 0, shadowed = 0, pixels = 0;
  };

  Compared compare(LitMap& map, const Kind& kind, const BiasMethod& bias, const Filter& filter, int side) {
    const Method method = atDefaults(bias, map.seen);
    const std::vector<float> own = map.lit.visibility(method, filter.id);
    ExportChoice choice = choiceOf(kind, bias, filter, Language::Glsl);
    choice.map.side = side;
    choice.scene = exportedScene(map.seen.scene());
    std::string text = exportShader(choice).text;
    // Behind the bindings of the scene.
    constexpr uint32_t kFirst = 50;
    text = std::regex_replace(text, std::regex("layout\\(binding = "), "layout(binding = 5");
    gpu::ShaderSource source = gpu::testShader("evaluate_export.comp.glsl",
                                               std::filesystem::path(test::inSource(GNOMON_TEST_FOLDER)) / "export");
    source.overrides["tests/exported.glsl"] = text;
    source.overrides["tests/exported_map.glsl"] = fillOf(text, choice.map.sliceCount);
    const gpu::ComputeProgram program(device(), source, {{.id = 4, .value = map.seen.buffers().instanced ? 1 : 0}});

    const auto& image = dynamic_cast<const MapImage&>(map.lit.occluders(bias.channels));
    const SceneBuffers& scene = map.seen.buffers();
    const MeshLinks links = linkMeshes(map.seen.scene(), scene.instanced);
    std::vector<glm::vec4> columns;
    for (const Instance& instance : map.seen.scene().instances)
      for (int i = 0; i < 4; ++i) columns.push_back(instance.worldFromMesh[i]);
    const gpu::Buffer instances = gpu::createTexelsWith(device(), "columns", VK_FORMAT_R32G32B32A32_SFLOAT, columns);
    const gpu::Buffer chunks = gpu::createTexelsWith(device(), "chunks", VK_FORMAT_R32G32_UINT, scene.ids.chunks);
    const gpu::Buffer facts = gpu::createTexelsWith(device(), "facts", VK_FORMAT_R32G32_UINT, links.facts);
    std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                          {glsl::kBindTriangles, scene.triangles},
                                          {glsl::kBindInstances, scene.instances},
                                          {glsl::kBindMap, image.uniforms()},
                                          {glsl::kBindPrimitiveIds, map.seen.gbuffer().primitiveIds()},
                                          {glsl::kBindShade, map.passes.visibility.uniforms()},
                                          {glsl::kBindVisibility, map.passes.visibility.visibility()}};
    for (const ExportedResource& resource : exportShader(choice).resources) {
      const uint32_t at = kFirst + static_cast<uint32_t>(resource.binding);
      if (resource.name == "gnomonDepth") bindings.emplace_back(at, image.image(glsl::kChannelDepth));
      if (resource.name == "gnomonSecondDepth") bindings.emplace_back(at, image.image(glsl::kChannelSecondDepth));
      if (resource.name == "gnomonBackDepth") bindings.emplace_back(at, image.image(glsl::kChannelBackDepth));
      if (resource.name == "gnomonIds") bindings.emplace_back(at, image.image(glsl::kChannelIds));
      if (resource.name == "gnomonMeshRows") bindings.emplace_back(at, scene.meshRows);
      if (resource.name == "gnomonInstances") bindings.emplace_back(at, instances);
      if (resource.name == "gnomonIdChunks") bindings.emplace_back(at, chunks);
      if (resource.name == "gnomonTriangleTable") bindings.emplace_back(at, facts);
    }
    gpu::Commands commands(device(), "exported visibility");
    commands.dispatch(program, shadeGroups(map.seen.view().width, map.seen.view().height), {}, bindings);
    commands.submitAndWait();
    const std::vector<float> exported = gpu::downloadAs<float>(device(), map.passes.visibility.visibility());
    Compared compared;
    for (size_t i = 0; i < own.size(); ++i) {
      compared.different += apart(own[i], exported[i]) > apartAtMost() ? 1 : 0;
      compared.shadowed += own[i] < 1.0f && map.lit.receivers().states[i] == PixelState::Scored ? 1 : 0;
    }
    compared.pixels = own.size();
    return compared;
  }

  // A caller's glue: the members that the file's map has, from Gnomon's own uniforms.
  static std::string fillOf(const std::string& text, int sliceCount) {
    const size_t at = text.find("struct GnomonShadowMap {");
    const std::string members = at == std::string::npos ? "" : text.substr(at, text.find("};", at) - at);
    std::string fill =
        "float exportedVisibility(vec3 place, vec3 normal, uint triangleId, ivec2 pixel) {\n  GnomonLightFrame "
        "frame;\n";
    if (!members.empty()) fill += "  GnomonShadowMap map;\n";
    for (const char* axis : {"originW", "rightW", "upW", "backW"})
      fill += fmt::format("  frame.{0} = lightFrame.{0};\n", axis);
    for (const char* member : {"zNear", "zFar", "clipDepth"})
      if (std::regex_search(members, std::regex(fmt::format(" {};", member))))
        fill += fmt::format("  map.{0} = shadowMap.{0};\n", member);
    if (mentions(members, " frame;")) fill += "  map.frame = frame;\n";
    const size_t slice = text.find("struct GnomonMapSlice {");
    const std::string matrices = slice == std::string::npos ? "" : text.substr(slice, text.find("};", slice) - slice);
    for (int i = 0; i < sliceCount; ++i)
      for (const char* matrix : {"clipFromLight", "lightFromClip"}) {
        if (!mentions(matrices, fmt::format(" {};", matrix))) continue;
        if (mentions(members, " projection;"))
          fill += fmt::format("  map.projection.{0} = mapSlices[0].{0};\n", matrix);
        if (mentions(members, " projections["))
          fill += fmt::format("  map.projections[{1}].{0} = mapSlices[{1}].{0};\n", matrix, i);
      }
    return fill + "  return " + calls(text, "pixel", "place", "normal") + ";\n}\n";
  }
};

// Every bias on a cube and a spot map.
TEST_F(ExportOnTheGpu, GivesTheVisibilityOfGnomonsPass) {
  for (const Kind& kind : {kinds()[0], kinds()[1]}) {
    LitMap map(device(), "factory", kind.map, 96, {.side = 64, .options = kind.options});
    for (const BiasMethod& bias : biasMethods()) {
      const Compared seen = compare(map, kind, bias, filters()[0], 64);
      EXPECT_EQ(seen.different, 0u) << kind.label << " " << bias.name << " of " << seen.pixels;
      EXPECT_GT(seen.shadowed, seen.pixels / 50) << kind.label << " " << bias.name;
    }
  }
}

TEST_F(ExportOnTheGpu, GivesItThroughFiltersAndOnOtherMaps) {
  struct Asked {
    const char* bias;
    int filter;  // in the list
  };
  for (const Kind& kind : kinds()) {
    LitMap map(device(), "contact", kind.map, 96, {.side = 64, .options = kind.options});
    const bool isCube = std::string(kind.label) == "cube";
    for (const Asked& asked : isCube ? std::vector<Asked>{{"adaptive", 2}, {"two-plane-depth", 1}, {"witness", 1}}
                                     : std::vector<Asked>{{"constant", 1}, {"witness", 0}}) {
      const Compared seen = compare(map, kind, findBias(asked.bias), filters()[asked.filter], 64);
      EXPECT_EQ(seen.different, 0u) << kind.label << " " << asked.bias << " of " << seen.pixels;
      EXPECT_GT(seen.shadowed, seen.pixels / 50) << kind.label << " " << asked.bias;
    }
  }
}

TEST_F(ExportOnTheGpu, GivesItOfAUsersBias) {
  for (const Kind& kind : {kinds()[1], kinds()[3]}) {
    LitMap map(device(), "contact", kind.map, 96, {.side = 64, .options = kind.options});
    for (const char* file : {"my_bias.glsl", "filament_bias.glsl"}) {
      const auto user = sampleBias(file);
      const Compared seen = compare(map, kind, user->method, filters()[0], 64);
      EXPECT_EQ(seen.different, 0u) << kind.label << " " << file << " of " << seen.pixels;
      EXPECT_GT(seen.shadowed, seen.pixels / 50) << kind.label << " " << file;
    }
  }
}

// The mesh's tables, with instances, some mirrored.
TEST_F(ExportOnTheGpu, GivesItOfInstances) {
  const Kind kind = kinds()[1];
  LitMap map(device(), "crowd:10000", kind.map, 128, {.side = 64, .options = kind.options});
  ASSERT_TRUE(map.seen.buffers().instanced);
  for (const char* bias : {"priority-depth", "two-plane", "witness"}) {
    const Compared seen = compare(map, kind, findBias(bias), filters()[0], 64);
    EXPECT_EQ(seen.different, 0u) << bias << " of " << seen.pixels;
    EXPECT_GT(seen.shadowed, seen.pixels / 50) << bias;
  }
}

// The headers: two maps of different kinds in one shader, each asked through the fetches of its own.
TEST_F(ExportOnTheGpu, HeadersGiveItOfTwoMapsInOneShader) {
  LitMap cube(device(), "contact", cubeParameterization(), 96, {.side = 64});
  LitMap spot(device(), "contact", spotParameterization(), 96, {.side = 48});
  gpu::ShaderSource source = gpu::testShader("evaluate_headers.comp.glsl",
                                             std::filesystem::path(test::inSource(GNOMON_TEST_FOLDER)) / "export");
  for (const auto& [name, text] : publicHeaders()) source.overrides["gnomon/glsl/" + name] = text;
  for (const char* bias :
       {"constant", "slope", "normal-offset", "adaptive", "dual", "godot", "two-plane-depth", "witness"})
    for (const Filter& filter : {filters()[0], filters()[1]}) {
      const BiasMethod& method = findBias(bias);
      const std::vector<gpu::Specialization> constants = {{.id = 4, .value = 0},
                                                          {.id = 20, .value = method.id},
                                                          {.id = 21, .value = filter.id},
                                                          {.id = 22, .value = filter.tapCount},
                                                          {.id = 23, .value = method.channels}};
      const gpu::ComputeProgram program(device(), source, constants);
      size_t shadowed = 0;
      for (LitMap* map : {&cube, &spot}) {
        const Method chosen = atDefaults(method, map->seen);
        const std::vector<float> own = map->lit.visibility(chosen, filter.id);
        const auto image = [&](LitMap& of) -> const MapImage& {
          return dynamic_cast<const MapImage&>(of.lit.occluders(method.channels));
        };
        const auto channel = [&](LitMap& of, ChannelSet wanted) -> const gpu::Image& {
          return image(of).imageOrAny(wanted);
        };
        const bool ids = (method.channels & glsl::kChannelIds) != 0;
        const gpu::Image none(
            device(),
            {.name = "no ids", .format = VK_FORMAT_R32_UINT, .array = true, .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
        const auto idsOf = [&](LitMap& of) -> const gpu::Image& {
          return ids ? image(of).image(glsl::kChannelIds) : none;
        };
        const SceneBuffers& scene = map->seen.buffers();
        struct {
          int32_t source;
          float endMargin;
        } push{map == &cube ? 0 : 1, scene.endMargin};
        gpu::Commands commands(device(), "visibility by the headers");
        commands.dispatch(program, shadeGroups(map->seen.view().width, map->seen.view().height), gpu::asPush(push),
                          {{glsl::kBindPositions, scene.positions},
                           {glsl::kBindTriangles, scene.triangles},
                           {glsl::kBindInstances, scene.instances},
                           {glsl::kBindMap, image(*map).uniforms()},
                           {glsl::kBindPrimitiveIds, map->seen.gbuffer().primitiveIds()},
                           {glsl::kBindShade, map->passes.visibility.uniforms()},
                           {glsl::kBindVisibility, map->passes.visibility.visibility()},
                           {glsl::kBindMeshRows, scene.meshRows},
                           {50, channel(cube, glsl::kChannelDepth)},
                           {51, channel(spot, glsl::kChannelDepth)},
                           {52, idsOf(cube)},
                           {53, idsOf(spot)},
                           {54, channel(cube, glsl::kChannelSecondDepth)},
                           {55, channel(spot, glsl::kChannelSecondDepth)}});
        commands.submitAndWait();
        const std::vector<float> given = gpu::downloadAs<float>(device(), map->passes.visibility.visibility());
        // The point to which a bias moves the receiver may be off by rounding where a compiler sees the map's numbers
        // otherwise (docs/shared_glsl.md): so are the weights of bilinear taps around it.
        const bool isMoved = std::string_view(bias) == "normal-offset" || std::string_view(bias) == "godot";
        size_t different = 0;
        for (size_t i = 0; i < own.size(); ++i) {
          const bool isNear = isMoved && std::abs(own[i] - given[i]) < 1e-4f;
          different += apart(own[i], given[i]) > apartAtMost() && !isNear ? 1 : 0;
          shadowed += own[i] < 1.0f && map->lit.receivers().states[i] == PixelState::Scored ? 1 : 0;
        }
        EXPECT_EQ(different, 0u) << bias << " " << filter.name << (map == &cube ? " cube" : " spot");
      }
      EXPECT_GT(shadowed, 200u) << bias;
    }
}

}  // namespace
}  // namespace gnomon
