#pragma once
// The plan of a sweep: a JSON file, comments allowed, whose axes are multiplied. docs/plan.schema.json is made of the
// fields declared here; docs/sweep.md explains them.

#include "lab/results/schema.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

// Where in the file an item stands, for complaints.
struct Placed {
  std::string where;  // "maps[1]"
};

// A word, or several: of a list of names each knows its place.
struct PlanName : Placed {
  std::string name;

  static constexpr const char* kShorthand = "name";
  static constexpr auto fields() { return std::tuple(field("name", &PlanName::name, {.says = "a name"})); }
};

struct PlanScene : Placed {
  std::string scene, name, solids = "file";
  std::vector<std::string> casters, excluded;

  static constexpr const char* kShorthand = "scene";
  static constexpr auto fields() {
    return std::tuple(
        field("scene", &PlanScene::scene,
              {.says = "a glTF file, a pattern of files as in scenes/*.glb, relative to the plan; or the name of a "
                       "generated scene, generated:* for all"}),
        field("name", &PlanScene::name,
              {.says = "what results call it; default: the file's name without its ending", .absent = Absent::Earlier}),
        field("solids", &PlanScene::solids, {.says = "file, closed or auto, as --solids", .absent = Absent::Earlier}),
        field("casters", &PlanScene::casters,
              {.says = "nodes or meshes that alone cast shadows, as --casters", .absent = Absent::Earlier}),
        field("excluded", &PlanScene::excluded,
              {.says = "nodes or meshes that cast none, as --exclude", .absent = Absent::Earlier}));
  }
};

// Lights or cameras.
struct PlanPlace : Placed {
  std::string name = "default";
  int random = 0;

  static constexpr const char* kShorthand = "name";
  static constexpr auto fields() {
    return std::tuple(
        field("name", &PlanPlace::name,
              {.says = "all of the scene's; default, the one that compare takes; or what --light and --camera take. A "
                       "name that a scene lacks is passed over there, if another scene of the plan has it",
               .absent = Absent::Earlier}),
        field("random", &PlanPlace::random,
              {.says = "so many, drawn with the plan's seed, instead of a name: cameras that see something that one "
                       "of the lights lights, point lights that light something",
               .absent = Absent::Earlier,
               .most = 10000}));
  }
};

struct PlanMap : Placed {
  std::string map;
  NamedTexts options;

  static constexpr const char* kShorthand = "map";
  static constexpr auto fields() {
    return std::tuple(field("map", &PlanMap::map, {.says = "its name, as --maps has it"}),
                      field("options", &PlanMap::options,
                            {.says = "its options by the names of their flags, as in {\"warp\": \"lispsm\"}",
                             .absent = Absent::Earlier}));
  }
};

// By a parameter's name the values to try.
using PlanParameters = std::vector<std::pair<std::string, std::vector<double>>>;

struct PlanBias : Placed {
  std::string bias, file;  // one of the two
  PlanParameters parameters;
  NamedTexts choices;
  bool tune = false;

  static constexpr const char* kShorthand = "bias";
  static constexpr auto fields() {
    return std::tuple(
        field("bias", &PlanBias::bias, {.says = "its name, as --biases has it; or all", .absent = Absent::Earlier}),
        field(
            "file", &PlanBias::file,
            {.says = "instead: a GLSL file with a bias of your own, relative to the plan", .absent = Absent::Earlier}),
        field("parameters", &PlanBias::parameters,
              {.says = "values to try, by the parameter's name: a number or a list; several are multiplied",
               .absent = Absent::Earlier}),
        field("choices", &PlanBias::choices, {.says = "as in {\"witness-reach\": \"4\"}", .absent = Absent::Earlier}),
        field("tune", &PlanBias::tune,
              {.says = "search the parameters for each case, as --tune", .absent = Absent::Earlier}));
  }
};

struct PlanMedium : Placed {
  std::vector<std::string> integrators = {"runs", "march"};
  std::vector<int> steps = {128};
  double sigmaS = 0.0, sigmaA = 0.0, g = 0.2, bound = 0.003;
  std::string map = "cube";
  int mapSize = 1024;

  static constexpr auto fields() {
    return std::tuple(
        field("integrators", &PlanMedium::integrators,
              {.says = "as gnomon fog --integrators", .absent = Absent::Earlier}),
        field("steps", &PlanMedium::steps,
              {.says = "of those that take steps", .absent = Absent::Earlier, .least = 1, .most = 65536}),
        field("sigma_s", &PlanMedium::sigmaS,
              {.unit = "1/m",
               .says = "scattering; 0: so that the scene's diagonal is half an optical depth",
               .absent = Absent::Earlier,
               .least = 0,
               .most = 1e6}),
        field("sigma_a", &PlanMedium::sigmaA,
              {.unit = "1/m", .says = "absorption", .absent = Absent::Earlier, .least = 0, .most = 1e6}),
        field("g", &PlanMedium::g,
              {.says = "anisotropy of the phase function", .absent = Absent::Earlier, .least = -0.99, .most = 0.99}),
        field("bound", &PlanMedium::bound,
              {.says = "of the reference, as gnomon fog --bound", .absent = Absent::Earlier, .least = 1e-5, .most = 1}),
        field("map", &PlanMedium::map, {.says = "that a march reads: cube or paraboloid", .absent = Absent::Earlier}),
        field("map_size", &PlanMedium::mapSize,
              {.unit = "texels", .says = "of that map", .absent = Absent::Earlier, .least = 2, .most = 16384}));
  }
};

// Cases that are left out: those that every pattern fits.
struct PlanExclusion : Placed {
  std::string scene = "*", light = "*", camera = "*", map = "*", bias = "*", filter = "*";
  std::vector<int> mapSizes;

  static constexpr auto fields() {
    const char* says = "a pattern as of a shell";
    return std::tuple(field("scene", &PlanExclusion::scene, {.says = says, .absent = Absent::Earlier}),
                      field("light", &PlanExclusion::light, {.says = says, .absent = Absent::Earlier}),
                      field("camera", &PlanExclusion::camera, {.says = says, .absent = Absent::Earlier}),
                      field("map", &PlanExclusion::map, {.says = says, .absent = Absent::Earlier}),
                      field("map_sizes", &PlanExclusion::mapSizes,
                            {.unit = "texels", .says = "none: all", .absent = Absent::Earlier, .least = 1}),
                      field("bias", &PlanExclusion::bias, {.says = says, .absent = Absent::Earlier}),
                      field("filter", &PlanExclusion::filter, {.says = says, .absent = Absent::Earlier}));
  }
};

struct Plan {
  std::string name;
  int seed = 1;
  std::string size = "512";
  int repeats = 3;
  std::vector<PlanScene> scenes;
  std::vector<PlanPlace> lights = {PlanPlace{}}, cameras = {PlanPlace{}};
  std::vector<PlanMap> maps;
  std::vector<int> mapSizes;
  std::vector<int> mapTexels;
  std::string cull = "solids";
  std::vector<PlanBias> biases;
  std::vector<PlanName> filters = {PlanName{{}, "none"}};
  std::vector<PlanMedium> media;
  std::vector<PlanExclusion> exclude;
  int worstPictures = 10;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &Plan::name, {.says = "a title for reports", .absent = Absent::Earlier}),
        field("seed", &Plan::seed,
              {.says = "of random lights and cameras: the same seed draws the same", .absent = Absent::Earlier}),
        field("size", &Plan::size, {.says = "of the pictures, as --size", .absent = Absent::Earlier}),
        field("repeats", &Plan::repeats,
              {.says = "of every timing; 0: nothing is timed", .absent = Absent::Earlier, .most = 1000}),
        field("scenes", &Plan::scenes, {.says = "scenes, each by name, file or pattern, or as an object"}),
        field("lights", &Plan::lights, {.says = "of every scene; default: [\"default\"]", .absent = Absent::Earlier}),
        field("cameras", &Plan::cameras, {.says = "likewise", .absent = Absent::Earlier}),
        field("maps", &Plan::maps,
              {.says = "each meets the lights of its kind; where a scene has none, those it can make do with",
               .absent = Absent::Earlier}),
        field("map_sizes", &Plan::mapSizes,
              {.unit = "texels",
               .says = "sides of a map's images; default, without map_texels: 1024",
               .absent = Absent::Earlier,
               .least = 2,
               .most = 16384}),
        field("map_texels", &Plan::mapTexels,
              {.says = "texels of all images together, as --map-texels", .absent = Absent::Earlier, .least = 4}),
        field("cull", &Plan::cull, {.says = "solids or none, as --cull", .absent = Absent::Earlier}),
        field("biases", &Plan::biases,
              {.says = "each by name, or as an object with values to try", .absent = Absent::Earlier}),
        field("filters", &Plan::filters, {.says = "none, bilinear, jitter4x4", .absent = Absent::Earlier}),
        field("media", &Plan::media,
              {.says = "light in a medium, as gnomon fog has it: each meets every scene, light and camera",
               .absent = Absent::Earlier}),
        field("exclude", &Plan::exclude, {.says = "cases to leave out", .absent = Absent::Earlier}),
        field("worst_pictures", &Plan::worstPictures,
              {.says = "keep pictures of so many of each method's worst cases; 0: none",
               .absent = Absent::Earlier,
               .most = 1000}));
  }

  // Not of the file's text, but of its place and what it holds.
  std::filesystem::path path, folder;
  std::vector<std::pair<std::string, size_t>> offsets;  // of values in the text, by their path
  std::string text;

  // Throws WorldError: "plan.json:12:7: maps[1] names no map; ...".
  [[noreturn]] void fail(const std::string& where, const std::string& what) const;
};

// Throws WorldError that names line, column and path of the first mistake in it.
Plan readPlan(const std::filesystem::path& path);
// The same of a text; `path` is what complaints name, and what files are relative to.
Plan parsePlan(const std::filesystem::path& path, const std::string& text);

// docs/plan.schema.json.
std::string planJsonSchema();

}  // namespace gnomon
