#include "lab/sweep/measure.h"

#include "lab/store/content_hash.h"
#include "lab/sweep/results_version.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

const char* lightTypeName(LightType type) {
  return type == LightType::Point ? "point" : type == LightType::Spot ? "spot" : "directional";
}

void addLight(ContentHash& hash, const Light& light) {
  hash.add(static_cast<int>(light.type));
  hash.addValues(std::span(&light.positionW.x, 3));
  hash.addValues(std::span(&light.directionW.x, 3));
  hash.addValues(std::span(&light.color.x, 3));
  hash.add(light.intensity);
  hash.add(light.outerConeRad);
}

void addCamera(ContentHash& hash, const Camera& camera, const PictureSize& size) {
  hash.addValues(std::span(&camera.worldFromEye[0][0], 16));
  hash.add(camera.yFovRad);
  hash.add(camera.zNear);
  hash.add(size.width);
  hash.add(size.height);
}

class Wanted {
 public:
  Wanted(const Plan& plan, const Axes& axes, const Survey& survey, const SweepView& view, const Machine& machine)
      : plan_(plan),
        axes_(axes),
        scene_(survey.scenes[view.scene]),
        axis_(axes.scenes[scene_.at]),
        light_(scene_.lights[view.light]),
        camera_(scene_.cameras[view.camera]),
        size_(parseSize(plan.size, camera_.thing.aspect)) {
    ContentHash hash;
    hash.add(machine.results);
    hash.add(machine.device);
    hash.add(machine.driver);
    hash.add(scene_.hash);
    addCamera(hash, camera_.thing, size_);
    addLight(hash, light_.thing);
    wanted_.key = hash.digits();
  }

  WantedView make() {
    for (size_t i = 0; i < axes_.maps.size(); ++i) addCase(i);
    for (size_t i = 0; i < axes_.media.size(); ++i) addMedia(i);
    return std::move(wanted_);
  }

 private:
  StoredCase known() const {
    return {.scene = axis_.name,
            .sceneHash = scene_.hash,
            .sceneSource = axis_.setup.scene,
            .triangles = scene_.triangles,
            .diagonal = scene_.diagonal,
            .light = light_.name,
            .lightType = lightTypeName(light_.thing.type),
            .camera = camera_.name,
            .width = size_.width,
            .height = size_.height};
  }

  // What the plan calls it: names, and the seed where they are drawn.
  std::string slotOf(const std::string& rest) const {
    const auto drawn = [&](const std::string& name) {
      return name.starts_with("random ") ? fmt::format("{} of seed {}", name, plan_.seed) : name;
    };
    return hashOf(fmt::format("{}\n{}\n{}\n{}x{}\n{}", axis_.name, drawn(camera_.name), drawn(light_.name), size_.width,
                              size_.height, rest));
  }

  void addCase(size_t index) {
    const SweepMap& map = axes_.maps[index];
    if (!meets(*map.map, light_.thing, scene_.lights)) return;
    WantedCase made{.map = index, .stored = known()};
    made.stored.map = map.map->name();
    made.stored.mapOptions = map.optionsText;
    made.stored.mapSize = mapSideOf(map.choice, *map.map);
    ContentHash hash;
    hash.add(wanted_.key);
    hash.add(made.stored.map);
    hash.add(made.stored.mapOptions);
    hash.add(made.stored.mapSize);
    hash.add(static_cast<int>(map.choice.cull));
    made.stored.key = hash.digits();
    for (size_t m = 0; m < axes_.methods.size(); ++m) {
      const SweepMethod& method = axes_.methods[m];
      if (!map.map->supportsBias(*method.bias)) continue;
      for (size_t f = 0; f < axes_.filters.size(); ++f) {
        const Filter& filter = *axes_.filters[f];
        if (filter.id != glsl::kShadowFilterNone && !map.map->supportsFilters()) continue;
        if (isExcluded(plan_, {axis_.name, light_.name, camera_.name, made.stored.map, method.bias->name, filter.name,
                               made.stored.mapSize}))
          continue;
        made.rows.push_back({.method = m,
                             .filter = f,
                             .key = rowKey(made.stored.key, method, filter),
                             .slot = slotOf(fmt::format("{} {} {} {}\n{}\n{}", made.stored.map, made.stored.mapOptions,
                                                        made.stored.mapSize, plan_.cull, method.label, filter.name))});
      }
    }
    if (!made.rows.empty()) wanted_.cases.push_back(std::move(made));
  }

  static std::string rowKey(const std::string& caseKey, const SweepMethod& method, const Filter& filter) {
    ContentHash hash;
    hash.add(caseKey);
    hash.add(method.bias->name);
    for (const auto& [knob, value] : method.knobs.knobs) {
      hash.add(knob->name);
      hash.add(value);
    }
    for (const BiasChoice* choice : method.bias->choices) hash.add(method.knobs.choices.*choice->member);
    hash.add(method.tune);
    hash.add(method.user ? method.user->source : std::string());
    hash.add(filter.name);
    return hash.digits();
  }

  void addMedia(size_t index) {
    const SweepMedium& medium = axes_.media[index];
    if (light_.thing.type == LightType::Directional) return;
    WantedMedia made{.medium = index, .stored = known()};
    made.stored.map = medium.map->name();
    made.stored.mapSize = medium.spec.mapSize;
    ContentHash hash;
    hash.add(wanted_.key);
    hash.add("medium");
    hash.add(made.stored.map);
    hash.add(made.stored.mapSize);
    for (const double value : {medium.spec.sigmaS, medium.spec.sigmaA, medium.spec.g, medium.spec.bound})
      hash.add(value);
    made.stored.key = hash.digits();
    if (isExcluded(plan_, {.scene = axis_.name, .light = light_.name, .camera = camera_.name, .map = made.stored.map}))
      return;
    for (size_t m = 0; m < medium.methods.size(); ++m) {
      const std::string name = fmt::format("{} {}", medium.methods[m].integrator->name, medium.methods[m].steps);
      made.rows.push_back({.method = m,
                           .key = hashOf(made.stored.key + name),
                           .slot = slotOf(fmt::format("medium {} {} {} {} {}", medium.label, medium.spec.bound,
                                                      made.stored.map, made.stored.mapSize, name))});
    }
    wanted_.media.push_back(std::move(made));
  }

  const Plan& plan_;
  const Axes& axes_;
  const SurveyedScene& scene_;
  const SweepScene& axis_;
  const Chosen<Light>& light_;
  const Chosen<Camera>& camera_;
  const PictureSize size_;
  WantedView wanted_;
};

}  // namespace

size_t WantedView::rowCount() const {
  size_t count = 0;
  for (const WantedCase& one : cases) count += one.rows.size();
  for (const WantedMedia& one : media) count += one.rows.size();
  return count;
}

Machine machineOf(const gpu::Device& device, const SweepOptions& options) {
  return {.program = options.program,
          .results = resultsVersion(),
          .device = device.info().name,
          .driver = device.info().driver,
          .host = machineName()};
}

WantedView missingOf(const WantedView& wanted, Store& store) {
  WantedView missing{.key = wanted.key};
  const auto isThere = [&](const auto& row) { return store.has(row.key, row.slot); };
  for (WantedCase one : wanted.cases) {
    std::erase_if(one.rows, isThere);
    if (!one.rows.empty() && !store.isEmpty(one.stored.key)) missing.cases.push_back(std::move(one));
  }
  for (WantedMedia one : wanted.media) {
    std::erase_if(one.rows, isThere);
    if (!one.rows.empty() && !store.isEmpty(one.stored.key)) missing.media.push_back(std::move(one));
  }
  return missing;
}

WantedView wantedOf(const Plan& plan, const Axes& axes, const Survey& survey, const SweepView& view,
                    const Machine& machine) {
  return Wanted(plan, axes, survey, view, machine).make();
}

}  // namespace gnomon
