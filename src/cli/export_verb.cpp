#include "base/error.h"
#include "base/file.h"
#include "base/suggest.h"
#include "base/terminal.h"
#include "cli/bias_flags.h"
#include "cli/choice.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/unused_flags.h"
#include "cli/verbs.h"
#include "lab/export/export_shader.h"
#include "lab/export/public_headers.h"
#include "lab/results/results_file.h"
#include "shadow/user_bias_check.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct ExportFlags {
  const CLI::App* verb = nullptr;
  SetupOptions setup;
  std::string map = "cube", bias = kDefaultBias, filter = "none", language = "glsl";
  std::string biasFile;
  std::vector<std::string> biasFileKnobs;
  std::string cubeDepth = "hyperbolic";
  int cascades = 1;
  int side = 1024;
  std::string results;
  std::optional<int> row;
  std::map<std::string, float> knobs;          // flag -> value
  std::map<std::string, std::string> choices;  // by flag
  std::string out = "-";
  std::string headers;
  std::vector<const CLI::Option*> ofRow;  // that --results takes from the row
};

std::vector<std::string> exportedMaps() {
  return {"cube", "paraboloid", "spot", "directional"};
}

// One of a list by its name. Throws UsageError.
template <typename T>
const T& named(const char* flag, const char* what, const std::string& name, const std::vector<T>& all) {
  std::string names;
  for (const T& one : all) {
    if (name == one.name) return one;
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  throw UsageError(fmt::format("{} {}: no such {}; {}", flag, name, what, chooseFrom(name, names)));
}

const Filter& filterNamed(const std::string& name) {
  return named("--filter", "filter", name, filters());
}

const BiasMethod& biasNamed(const std::string& name) {
  return named("--bias", "bias", name, biasMethods());
}

void takeKnobs(const char* owner, const std::vector<Knob>& knobs, const ExportFlags& flags, ExportChoice& choice) {
  for (const Knob& knob : knobs) {
    const std::string flag = knobFlag(owner, knob);
    const auto found = flags.knobs.find(flag);
    if (found == flags.knobs.end()) continue;
    if (!(found->second >= knob.lower && found->second <= knob.upper))
      throw UsageError(fmt::format("{} {:g} is outside {:g}..{:g} {}", flag, found->second, knob.lower, knob.upper,
                                   unitName(knob.unit)));
    choice.knobs[&knob] = found->second;
  }
}

// The map, bias, filter and parameters of a row of results.json. `user`: of --bias-file, or null.
void takeRow(ExportFlags& flags, ExportChoice& choice, const UserBias* user) {
  const std::filesystem::path given = flags.results;
  if (!std::filesystem::is_directory(given) && given.filename() != "results.json")
    throw fileError(flags.results, std::filesystem::exists(given) ? "is no results.json" : "does not exist",
                    "name a folder that gnomon compare -o wrote; of a sweep's store, run the command of a row with -o");
  const Results results = readResults(std::filesystem::is_directory(given) ? given : given.parent_path());
  const Comparison* comparison = std::get_if<Comparison>(&results);
  if (comparison == nullptr)
    throw UsageError(fmt::format("--results {}: holds media, not shadows on surfaces", flags.results));
  const std::vector<Row> rows = ranked(comparison->rows);
  const int count = static_cast<int>(rows.size());
  const int wanted = flags.row.value_or(0);
  if (wanted < 0 || wanted >= count)
    throw UsageError(fmt::format("--row {}: {} has rows 0 to {}", wanted, flags.results, count - 1));
  const Row& row = rows[static_cast<size_t>(wanted)];
  const bool isOwn = std::ranges::none_of(biasMethods(), [&](const BiasMethod& one) { return row.bias == one.name; });
  if (isOwn && user == nullptr)
    throw UsageError(
        fmt::format("--row {} is of a bias of your own, {}: give its file with --bias-file", wanted, row.bias));
  if (isOwn && user->name != row.bias)
    throw UsageError(fmt::format("--bias-file {} holds the bias {}, and --row {} is of {}; give that one's file",
                                 flags.biasFile, user->name, wanted, row.bias));
  if (!isOwn && user != nullptr)
    throw UsageError(fmt::format("--bias-file and --results: row {} is of {}, which is Gnomon's", wanted, row.bias));
  flags.map = row.map;
  flags.bias = row.bias;
  flags.filter = row.filter;
  flags.side = row.mapSide;
  if (const std::string depth = paramText(row.params, "cube_depth"); !depth.empty()) flags.cubeDepth = depth;
  if (row.map == "directional") flags.cascades = row.layers;
  choice.map.name = row.map;
  const BiasMethod& bias = isOwn ? user->method : biasNamed(row.bias);
  const Filter& filter = filterNamed(row.filter);
  for (const Param& param : row.params) {
    const auto* number = std::get_if<double>(&param.value);
    for (const Knob& knob : knobsOf(bias))
      if (number != nullptr && param.name == knob.name) choice.knobs[&knob] = static_cast<float>(*number);
    for (const Knob& knob : filter.knobs)
      if (number != nullptr && param.name == filterParamName(knob.name))
        choice.knobs[&knob] = static_cast<float>(*number);
    for (const BiasChoice* one : biasChoices())
      if (param.name == one->name) choice.choices.*one->member = one->parse(paramText(param));
  }
  // What else a scene has to say comes from the scene itself, where it is named, too.
  if (flags.setup.scene.empty()) flags.setup.scene = comparison->scene.source;
}

int writeHeaders(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder / "gnomon" / "glsl", failure);
  if (failure) throw fileError(folder.string(), "cannot be made a folder", failure.message());
  for (const auto& [name, text] : publicHeaders()) writeTextFile(folder / "gnomon" / "glsl" / name, text);
  say(fmt::format("wrote {}: #include \"gnomon/glsl/visibility.glsl\"\n", (folder / "gnomon" / "glsl").string()));
  return 0;
}

// What the headers hold is all there is.
void refuseAllBesideHeaders(const ExportFlags& flags) {
  const UnusedFlags unused(*flags.verb);
  for (const CLI::Option* option : flags.verb->get_options())
    if (const std::string name = option->get_name(); name != "--headers" && name != "--help")
      unused.refuseUnless(false, name, "--headers writes all maps, biases and filters, for any scene");
}

// What belongs to another map, bias or filter than the chosen one, or to a scene.
void refuseUnusedFlags(const ExportFlags& flags, const ExportChoice& choice) {
  const UnusedFlags unused(*flags.verb);
  unused.refuseUnless(flags.map == "cube", "--cube-depth", fmt::format("the map {} has no such option", flags.map));
  unused.refuseUnless(flags.map == "directional", "--cascades",
                      fmt::format("the map {} has no such option", flags.map));
  const bool isOwn = choice.bias->user != nullptr;
  unused.refuseUnless(!isOwn, "--bias", "--bias-file is exported instead");
  unused.refuseUnless(isOwn, "--bias-file-knob", "it is for --bias-file");
  const std::string shared = choice.bias->sharesKnobsWith != nullptr ? choice.bias->sharesKnobsWith : "";
  for (const BiasMethod& method : biasMethods())
    for (const Knob& knob : method.knobs)
      unused.refuseUnless(std::string_view(method.name) == choice.bias->name || method.name == shared,
                          knobFlag(method.name, knob), fmt::format("the bias is {}", choice.bias->name));
  for (const Filter& filter : filters())
    for (const Knob& knob : filter.knobs)
      unused.refuseUnless(filter.name == flags.filter, knobFlag(filter.name, knob),
                          fmt::format("the filter is {}", flags.filter));
  for (const BiasChoice* one : biasChoices())
    unused.refuseUnless(std::ranges::find(choice.bias->choices, one) != choice.bias->choices.end(), one->flag(),
                        fmt::format("the bias {} has no such choice", choice.bias->name));
  unused.refuseUnless(false, "--solids", "no exported code depends on which meshes are solids");
  for (const char* flag : {"--scene-index", "--allow-path"})
    unused.refuseUnless(!flags.setup.scene.empty(), flag, "no SCENE is given");
}

std::shared_ptr<const UserBias> userBiasOf(const ExportFlags& flags) {
  if (flags.biasFile.empty()) return nullptr;
  std::shared_ptr<const UserBias> user = loadUserBias(flags.biasFile);
  checkUserBias(*user);
  return user;
}

int runExport(ExportFlags flags) {
  if (!flags.headers.empty()) {
    refuseAllBesideHeaders(flags);
    return writeHeaders(flags.headers);
  }
  ExportChoice choice;
  for (const BiasChoice* one : biasChoices()) choice.choices.*one->member = one->parse(flags.choices.at(one->flag()));
  const std::shared_ptr<const UserBias> user = userBiasOf(flags);
  if (!flags.results.empty()) {
    for (const CLI::Option* option : flags.ofRow)
      if (option->count() > 0 && option->get_name() != "--bias-file")
        throw UsageError(fmt::format("{} and --results: the row of the results has it already", option->get_name()));
    takeRow(flags, choice, user.get());
  } else if (flags.row) {
    throw UsageError("--row needs --results");
  }
  choice.bias = user ? &user->method : &biasNamed(flags.bias);
  choice.filter = &filterNamed(flags.filter);
  refuseUnusedFlags(flags, choice);
  std::vector<KnobValue> userKnobs;
  for (const std::string& text : flags.biasFileKnobs) setUserKnob(text, {user}, userKnobs);
  for (const KnobValue& one : userKnobs) choice.knobs[one.knob] = one.value;
  choice.map = exportedMap(flags.map, flags.cubeDepth == "radial", flags.cascades);
  choice.map.side = flags.side;
  takeKnobs(choice.bias->sharesKnobsWith != nullptr ? choice.bias->sharesKnobsWith : choice.bias->name,
            knobsOf(*choice.bias), flags, choice);
  takeKnobs(choice.filter->name, choice.filter->knobs, flags, choice);
  const std::vector<std::string>& languages = code::languageNames();
  choice.language = static_cast<code::Language>(std::ranges::find(languages, flags.language) - languages.begin());
  choice.command = commandLine();
  if (!flags.setup.scene.empty()) choice.scene = exportedScene(openScene(flags.setup));
  const ExportedShader exported = exportShader(choice);
  if (!isStream(flags.out)) checkOutput(flags.out);
  writeTextFile(flags.out, exported.text);
  if (!isStream(flags.out)) say(fmt::format("wrote {}\n", flags.out));
  return 0;
}

Run addExport(CLI::App* verb) {
  auto flags = std::make_shared<ExportFlags>();
  flags->verb = verb;
  addSceneFileFlags(*verb, flags->setup);
  {
    const OptionGroup group(*verb, "What to export");
    const auto ofRow = [&](CLI::Option* option) {
      flags->ofRow.push_back(option);
      return option;
    };
    std::vector<std::string> biases, names;
    for (const BiasMethod& method : biasMethods()) biases.emplace_back(method.name);
    for (const Filter& filter : filters()) names.emplace_back(filter.name);
    offersOneOf(
        ofRow(verb->add_option("--map", flags->map, "cube, paraboloid, spot or directional")->capture_default_str()),
        exportedMaps());
    offersOneOf(
        ofRow(verb->add_option("--bias", flags->bias, "by its name in `gnomon compare --help`")->capture_default_str()),
        biases);
    offersFiles(ofRow(verb->add_option("--bias-file", flags->biasFile,
                                       "GLSL file with your own bias, exported instead (docs/add_a_bias.md)")));
    ofRow(verb->add_option("--bias-file-knob", flags->biasFileKnobs,
                           "NAME=VALUE: a parameter of your bias, in its unit (VALUE alone if it has only one); may be "
                           "repeated")
              ->allow_extra_args(false));
    offersOneOf(
        ofRow(verb->add_option("--filter", flags->filter, "none, bilinear or jitter4x4")->capture_default_str()),
        names);
    offersOneOf(verb->add_option("--lang", flags->language, "the language")
                    ->check(oneOf(code::languageNames()))
                    ->capture_default_str(),
                code::languageNames());
    ofRow(verb->add_option("--map-size", flags->side, "texels of a slice's side")
              ->check(CLI::Range(2, 16384))
              ->capture_default_str());
    offersOneOf(ofRow(verb->add_option("--cube-depth", flags->cubeDepth, "how a cube map stores depth")
                          ->check(oneOf({"hyperbolic", "radial"}))
                          ->capture_default_str()),
                {"hyperbolic", "radial"});
    ofRow(verb->add_option("--cascades", flags->cascades, "slices of a directional map")
              ->check(CLI::Range(1, 4))
              ->capture_default_str());
    offersFiles(verb->add_option("--results", flags->results,
                                 "a results.json, or its folder: map, bias, filter and parameters are those of a row"));
    verb->add_option("--row", flags->row,
                     "which of its rows, best first as the table has them, counted from 0; default: 0");
    offersFolders(verb->add_option("--headers", flags->headers,
                                   "writes all maps, biases and filters as GLSL headers instead, into gnomon/glsl/ of "
                                   "this folder (docs/glsl.md)"));
    offersFiles(verb->add_option("-o,--out", flags->out, "the file; -: standard output")->capture_default_str());
  }
  const OptionGroup group(*verb, "Parameters");
  for (const BiasChoice* choice : biasChoices()) {
    const std::string flag = choice->flag();
    flags->choices[flag] = choice->values.front();
    CLI::Option* option = verb->add_option(flag, flags->choices[flag], choice->sentence)->capture_default_str();
    flags->ofRow.push_back(option);
    offersOneOf(option, {choice->values.begin(), choice->values.end()});
  }
  const auto addKnobs = [&](const char* owner, const std::vector<Knob>& knobs) {
    for (const Knob& knob : knobs) {
      const std::string flag = knobFlag(owner, knob);
      const std::string unit = *unitName(knob.unit) != '\0' ? fmt::format(" [{}]", unitName(knob.unit)) : "";
      CLI::Option* option = verb->add_option_function<float>(
          flag, [values = &flags->knobs, flag](float value) { (*values)[flag] = value; },
          fmt::format("{}: {}{}; default {:g}{}", owner, knob.sentence, unit, knob.defaultValue,
                      knob.defaultOfSceneScale ? " of the scene's diagonal" : ""));
      flags->ofRow.push_back(option);
    }
  };
  for (const BiasMethod& method : biasMethods()) addKnobs(method.name, method.knobs);
  for (const Filter& filter : filters()) addKnobs(filter.name, filter.knobs);
  return [flags] { return runExport(*flags); };
}

}  // namespace

Verb exportVerb() {
  return {
      .name = "export",
      .sentence = "writes the shader code of one map, bias and filter for your renderer: GLSL, GLSL ES, HLSL or Metal",
      .add = addExport};
}

}  // namespace gnomon
