#include "lab/sweep/axes.h"

#include "base/error.h"
#include "base/message.h"
#include "base/suggest.h"
#include "lab/core/maps.h"
#include "scene/generate.h"
#include "shadow/user_bias_check.h"

#include <fnmatch.h>
#include <glob.h>

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

constexpr const char* kGenerated = "generated:";

// What `work` finds wrong, as a mistake at a place of the plan.
template <typename Work>
auto at(const Plan& plan, const std::string& where, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const UsageError& error) {
    plan.fail(where, "is wrong: " + oneLine(printable(error.what()), 220));
  } catch (const WorldError& error) {
    plan.fail(where, "is wrong: " + oneLine(error.what(), 220));
  }
}

bool fits(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

bool isPattern(const std::string& text) {
  return text.find_first_of("*?[") != std::string::npos;
}

std::vector<std::string> filesLike(const std::string& pattern) {
  std::vector<std::string> files;
  glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  return files;
}

// Files or generated names that one item of the plan stands for.
std::vector<std::string> scenesOf(const Plan& plan, const PlanScene& item) {
  std::vector<std::string> scenes;
  if (item.scene.starts_with(kGenerated)) {
    for (const GeneratedScene& scene : generatedScenes())
      if (fits(item.scene.substr(std::string(kGenerated).size()), scene.name)) scenes.emplace_back(scene.name);
    if (scenes.empty()) plan.fail(item.where, "fits no generated scene (gnomon scene lists them)");
    return scenes;
  }
  const std::string path =
      fs::path(item.scene).is_absolute() ? item.scene : (plan.folder / item.scene).lexically_normal().string();
  if (isPattern(item.scene)) {
    scenes = filesLike(path);
    if (scenes.empty()) plan.fail(item.where, fmt::format("fits no file: {}", printable(path)));
    return scenes;
  }
  std::error_code failure;
  if (findGeneratedScene(item.scene) != nullptr || item.scene.starts_with("crowd:")) return {item.scene};
  if (!fs::exists(path, failure)) {
    std::string names;
    for (const GeneratedScene& scene : generatedScenes())
      names += (names.empty() ? "" : ", ") + std::string(scene.name);
    plan.fail(item.where, fmt::format("'{}' is neither a file nor a generated scene; {}", printable(item.scene),
                                      chooseFrom(item.scene, names)));
  }
  return {path};
}

std::string stemOf(const std::string& scene) {
  return findGeneratedScene(scene) != nullptr || scene.starts_with("crowd:") ? scene : fs::path(scene).stem().string();
}

void addScene(const Plan& plan, const PlanScene& item, const std::string& scene, Axes& axes) {
  SweepScene added{.spec = item, .name = item.name.empty() ? stemOf(scene) : item.name};
  added.setup.scene = scene;
  added.setup.size = plan.size;
  added.setup.choice = {.casters = item.casters, .excluded = item.excluded, .solids = parseSolids(item.solids)};
  for (const SweepScene& other : axes.scenes) {
    if (other.name != added.name) continue;
    if (other.setup.scene == scene && item.name.empty()) return;  // a file that two patterns fit
    plan.fail(item.where, fmt::format("'{}' is the name of two scenes ({} and {}); give one a \"name\"", added.name,
                                      printable(other.setup.scene), printable(scene)));
  }
  axes.scenes.push_back(std::move(added));
}

void addScenes(const Plan& plan, const std::vector<std::string>& folders, Axes& axes) {
  for (const PlanScene& item : plan.scenes) {
    if (std::ranges::find(solidsNames(), item.solids) == solidsNames().end())
      plan.fail(item.where + ".solids", "must be file, closed or auto");
    const std::vector<std::string> scenes = scenesOf(plan, item);
    if (scenes.size() > 1 && !item.name.empty()) plan.fail(item.where + ".name", "names several scenes");
    for (const std::string& scene : scenes) addScene(plan, item, scene, axes);
  }
  for (const std::string& folder : folders) {
    std::vector<std::string> files;
    std::error_code failure;
    for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure))
      if (it->path().extension() == ".gltf" || it->path().extension() == ".glb") files.push_back(it->path().string());
    if (files.empty()) throw fileError(folder, "has no .gltf or .glb file in it", "name a folder of scenes");
    std::ranges::sort(files);
    for (const std::string& file : files) addScene(plan, {}, file, axes);
  }
  if (axes.scenes.empty()) plan.fail("scenes", "are none; name at least one");
}

const Parameterization& findMap(const Plan& plan, const std::string& where, const std::string& name) {
  return *at(plan, where, [&] {
            std::vector<const Parameterization*> maps = parseMaps(name);
            if (maps.size() != 1) throw UsageError(fmt::format("'{}' names several maps; write a list", name));
            return maps;
          }).front();
}

MapOptions optionsOf(const Plan& plan, const PlanMap& item) {
  MapOptions options;
  const Parameterization& map = findMap(plan, item.where, item.map);
  std::string names;
  for (const MapOption* option : map.options()) names += (names.empty() ? "" : ", ") + option->flag().substr(2);
  for (const auto& given : item.options) {
    const std::string &name = given.first, &text = given.second;
    const std::string where = item.where + ".options." + name;
    const auto own = map.options();
    const auto found = std::ranges::find_if(
        own, [&](const MapOption* option) { return option->flag() == "--" + name || option->name() == name; });
    if (found == own.end())
      plan.fail(where, fmt::format("is no option of a {} map; {}", item.map, chooseFrom(name, names)));
    options.set({*found, at(plan, where, [&] { return (*found)->parsed(text); })});
  }
  at(plan, item.where, [&] { map.checkOptions(options); });
  return options;
}

// Whether the plan's text has this field.
bool stands(const Plan& plan, const std::string& field) {
  return std::ranges::find(plan.offsets, field, [](const auto& entry) { return entry.first; }) != plan.offsets.end();
}

void addMaps(const Plan& plan, Axes& axes) {
  const CullMode cull = at(plan, "cull", [&] { return parseCullMode(plan.cull); });
  std::vector<int> sizes = plan.mapSizes;
  for (const char* field : {"map_sizes", "map_texels"}) {
    const bool isEmpty = field == std::string_view("map_sizes") ? plan.mapSizes.empty() : plan.mapTexels.empty();
    if (isEmpty && stands(plan, field)) plan.fail(field, "are none; leave the field out, or give one");
  }
  if (sizes.empty() && plan.mapTexels.empty()) sizes = {1024};
  for (const PlanMap& item : plan.maps) {
    SweepMap map{.map = &findMap(plan, item.where, item.map)};
    map.choice.mapOptions = optionsOf(plan, item);
    map.choice.cull = cull;
    for (const ChosenOption& choice : map.choice.mapOptions.choices())
      map.optionsText += fmt::format("{}{}={}", map.optionsText.empty() ? "" : " ", choice.option->flag().substr(2),
                                     choice.option->textOf(choice.value));
    std::set<int> sides;  // no size twice, however it is named
    const auto add = [&](const std::string& where) {
      const int side = at(plan, where, [&] { return mapSideOf(map.choice, *map.map); });
      if (sides.insert(side).second) axes.maps.push_back(map);
    };
    for (size_t i = 0; i < sizes.size(); ++i) {
      map.choice.mapSide = sizes[i];
      add(fmt::format("map_sizes[{}]", i));
    }
    for (size_t i = 0; i < plan.mapTexels.size(); ++i) {
      map.choice.mapTexels = plan.mapTexels[i];
      add(fmt::format("map_texels[{}]", i));
    }
  }
}

// Of one item. A case takes milliseconds a method: a minute or so.
constexpr size_t kMostMethods = 10000;

std::string namesOfKnobs(const BiasMethod& bias) {
  std::string names;
  for (const Knob& knob : knobsOf(bias)) names += (names.empty() ? "" : ", ") + std::string(knob.name);
  return names;
}

// Once for each combination of the parameters' values.
void addMethods(const Plan& plan, const PlanBias& item, const BiasMethod& bias,
                const std::shared_ptr<const UserBias>& user, Axes& axes) {
  std::vector<SweepMethod> methods(1);
  methods.front().label = bias.name;
  methods.front().bias = &bias;
  methods.front().user = user;
  for (const auto& given : item.choices) {
    const std::string &name = given.first, &text = given.second;
    const std::string where = item.where + ".choices." + name;
    std::string names;
    const BiasChoice* found = nullptr;
    for (const BiasChoice* choice : bias.choices) {
      names += (names.empty() ? "" : ", ") + choice->flag().substr(2);
      if (choice->flag() == "--" + name || choice->name == name) found = choice;
    }
    if (found == nullptr)
      plan.fail(where, names.empty() ? fmt::format("is none of {}, which has no choices", bias.name)
                                     : fmt::format("is no choice of {}; {}", bias.name, chooseFrom(name, names)));
    methods.front().knobs.choices.*found->member = at(plan, where, [&] { return found->parse(text); });
    methods.front().label += fmt::format(" {}={}", name, text);
  }
  for (const auto& given : item.parameters) {
    const std::string& name = given.first;
    const std::vector<double>& values = given.second;
    const std::string where = item.where + ".parameters." + name;
    const std::vector<Knob>& knobs = knobsOf(bias);
    const auto knob = std::ranges::find_if(knobs, [&](const Knob& each) { return each.name == name; });
    if (knob == knobs.end())
      plan.fail(where, knobs.empty()
                           ? fmt::format("is none of {}, which has no parameter", bias.name)
                           : fmt::format("is no parameter of {}; {}", bias.name, chooseFrom(name, namesOfKnobs(bias))));
    if (methods.size() * values.size() > kMostMethods)
      plan.fail(item.where + ".parameters", fmt::format("makes more than {} methods", kMostMethods));
    std::vector<SweepMethod> product;
    for (const SweepMethod& method : methods) {
      for (const double value : values) {
        if (!(value >= static_cast<double>(knob->lower) && value <= static_cast<double>(knob->upper)))
          plan.fail(where, fmt::format("is {:g}, outside {:g}..{:g} {}", value, knob->lower, knob->upper,
                                       unitName(knob->unit)));
        SweepMethod made = method;
        made.knobs.knobs.push_back({&*knob, static_cast<float>(value)});
        made.label += fmt::format(" {}={:g}", name, value);
        product.push_back(std::move(made));
      }
    }
    methods = std::move(product);
  }
  if (item.tune) {
    if (!item.parameters.empty()) plan.fail(item.where + ".tune", "and parameters exclude each other; write two items");
    if (knobsOf(bias).empty()) {
      if (item.bias == "all") return;
      plan.fail(item.where + ".tune", fmt::format("cannot tune {}: it has no parameter", bias.name));
    }
    methods.front().tune = true;
    methods.front().label += " tuned";
  }
  for (SweepMethod& method : methods)
    if (std::ranges::none_of(axes.methods, [&](const SweepMethod& other) { return other.label == method.label; }))
      axes.methods.push_back(std::move(method));
}

std::shared_ptr<const UserBias> loadedBias(const std::string& path, const Axes& axes) {
  for (const SweepMethod& method : axes.methods)
    if (method.user && method.user->path == path) return method.user;
  std::shared_ptr<const UserBias> user = loadUserBias(path);
  checkUserBias(*user);
  const auto isNamed = [&](const auto& name) { return name == user->name; };
  if (std::ranges::any_of(biasMethods(), isNamed, &BiasMethod::name) ||
      std::ranges::any_of(axes.methods, isNamed, [](const SweepMethod& method) { return method.bias->name; }))
    throw UsageError(fmt::format("{}: two biases are named '{}'; write //! name: in one of them", path, user->name));
  return user;
}

void addBiases(const Plan& plan, const std::vector<std::string>& files, Axes& axes) {
  for (const PlanBias& item : plan.biases) {
    if (item.bias.empty() == item.file.empty()) plan.fail(item.where, "needs either a \"bias\" or a \"file\"");
    if (!item.file.empty()) {
      const std::string path =
          fs::path(item.file).is_absolute() ? item.file : (plan.folder / item.file).lexically_normal().string();
      const std::shared_ptr<const UserBias> user =
          at(plan, item.where + ".file", [&] { return loadedBias(path, axes); });
      addMethods(plan, item, user->method, user, axes);
      continue;
    }
    if (item.bias == "all" && !(item.parameters.empty() && item.choices.empty()))
      plan.fail(item.where, "gives all biases the same parameters; name one");
    for (const BiasMethod* bias : at(plan, item.where, [&] { return parseBiases(item.bias); }))
      addMethods(plan, item, *bias, nullptr, axes);
  }
  for (const std::string& file : files) {
    const std::shared_ptr<const UserBias> user = loadedBias(file, axes);
    addMethods(plan, {}, user->method, user, axes);
  }
}

void addMedia(const Plan& plan, Axes& axes) {
  for (const PlanMedium& item : plan.media) {
    SweepMedium medium{.spec = item};
    medium.map = &findMap(plan, item.where + ".map", item.map);
    if (!medium.map->looksAround()) plan.fail(item.where + ".map", "must be cube or paraboloid");
    for (size_t i = 0; i < item.integrators.size(); ++i) {
      const Integrator& integrator = at(plan, fmt::format("{}.integrators[{}]", item.where, i),
                                        [&]() -> const Integrator& { return findIntegrator(item.integrators[i]); });
      for (const int steps : integrator.takesSteps ? item.steps : std::vector{0})
        medium.methods.push_back({.integrator = &integrator, .steps = steps});
    }
    if (medium.methods.empty()) plan.fail(item.where, "has no integrator, or no steps");
    medium.label = fmt::format("sigma_s={:g} sigma_a={:g} g={:g}", item.sigmaS, item.sigmaA, item.g);
    axes.media.push_back(std::move(medium));
  }
}

// Lights and cameras are not known before their scenes are open.
void checkExclusions(const Plan& plan, const Axes& axes) {
  std::vector<std::string> scenes, maps, biases, filters;
  for (const SweepScene& scene : axes.scenes) scenes.push_back(scene.name);
  for (const SweepMap& map : axes.maps) maps.emplace_back(map.map->name());
  for (const SweepMedium& medium : axes.media) maps.emplace_back(medium.map->name());
  for (const SweepMethod& method : axes.methods) biases.emplace_back(method.bias->name);
  for (const Filter* filter : axes.filters) filters.emplace_back(filter->name);
  for (const PlanExclusion& item : plan.exclude) {
    const auto check = [&](const char* field, const std::string& pattern, const std::vector<std::string>& names) {
      if (pattern == "*" || std::ranges::any_of(names, [&](const auto& name) { return fits(pattern, name); })) return;
      std::string list;
      for (const std::string& name : std::set<std::string>(names.begin(), names.end()))
        list += (list.empty() ? "" : ", ") + name;
      plan.fail(fmt::format("{}.{}", item.where, field), fmt::format("is {}, which leaves out nothing of the plan; {}",
                                                                     oneLine(pattern, 40), chooseFrom(pattern, list)));
    };
    check("scene", item.scene, scenes);
    check("map", item.map, maps);
    check("bias", item.bias, biases);
    check("filter", item.filter, filters);
  }
}

}  // namespace

Axes axesOf(const Plan& plan, const std::vector<std::string>& extraScenes,
            const std::vector<std::string>& extraBiases) {
  Axes axes;
  at(plan, "size", [&] { parseSize(plan.size); });
  addScenes(plan, extraScenes, axes);
  addMaps(plan, axes);
  addBiases(plan, extraBiases, axes);
  addMedia(plan, axes);
  for (const PlanName& item : plan.filters)
    for (const Filter* filter : at(plan, item.where, [&] { return parseFilters(item.name); }))
      if (std::ranges::find(axes.filters, filter) == axes.filters.end()) axes.filters.push_back(filter);
  if (axes.maps.empty() != axes.methods.empty() || (axes.maps.empty() && axes.media.empty()))
    plan.fail("", "has nothing to measure: give \"maps\" and \"biases\", or \"media\"");
  if (axes.filters.empty() && !axes.maps.empty()) plan.fail("filters", "are none; leave the field out, or name one");
  if (plan.lights.empty()) plan.fail("lights", "are none; leave the field out, or name one");
  if (plan.cameras.empty()) plan.fail("cameras", "are none; leave the field out, or name one");
  for (const PlanPlace& place : plan.lights)
    if (place.random > 0 && place.name != "default") plan.fail(place.where, "has a name and random; give one of them");
  for (const PlanPlace& place : plan.cameras)
    if (place.random > 0 && place.name != "default") plan.fail(place.where, "has a name and random; give one of them");
  checkExclusions(plan, axes);
  return axes;
}

bool isExcluded(const Plan& plan, const CaseNames& names) {
  const auto isAll = [](const std::string& pattern) { return pattern == "*"; };
  return std::ranges::any_of(plan.exclude, [&](const PlanExclusion& item) {
    return fits(item.scene, names.scene) && fits(item.light, names.light) && fits(item.camera, names.camera) &&
           (names.map.empty() ? isAll(item.map) : fits(item.map, names.map)) &&
           (names.bias.empty() ? isAll(item.bias) : fits(item.bias, names.bias)) &&
           (names.filter.empty() ? isAll(item.filter) : fits(item.filter, names.filter)) &&
           (item.mapSizes.empty() || std::ranges::find(item.mapSizes, names.mapSize) != item.mapSizes.end());
  });
}

}  // namespace gnomon
