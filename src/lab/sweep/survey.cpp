#include "lab/sweep/survey.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/message.h"
#include "judge/ground_truth.h"
#include "lab/core/default_view.h"
#include "lab/core/maps.h"
#include "lab/store/content_hash.h"
#include "lab/sweep/random_places.h"
#include "lab/sweep/scene_survey.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Of all scenes that are kept in memory for the measurements.
constexpr size_t kMostTrianglesKept = 2'000'000;

// Of what can change a count: shapes, holes, what casts, what is a solid. Colours shade pictures and nothing else, but
// for the alpha of masks.
std::string hashOfScene(const Scene& scene) {
  ContentHash hash;
  for (const Mesh& mesh : scene.meshes) {
    hash.addValues(std::span<const glm::vec3>(mesh.positions));
    hash.addValues(std::span<const glm::vec3>(mesh.normals));
    hash.addValues(std::span<const glm::vec2>(mesh.uvs));
    hash.addValues(std::span<const uint32_t>(mesh.indices));
    hash.add(mesh.material);
    hash.add(mesh.closed);
    hash.add(mesh.solidAnyway);
  }
  for (const Material& material : scene.materials) {
    hash.addValues(std::span(&material.baseColor.x, 4));
    hash.add(material.baseColorTexture);
    hash.add(static_cast<int>(material.alphaMode));
    hash.add(material.alphaCutoff);
    hash.add(material.doubleSided);
  }
  hash.addValues(std::span<const glsl::TextureInfo>(scene.textures));
  hash.addValues(std::span<const uint32_t>(scene.texels));
  for (const Instance& instance : scene.instances) {
    hash.add(instance.mesh);
    hash.add(instance.casts);
    hash.addValues(std::span(&instance.worldFromMesh[0][0], 16));
  }
  hash.addValues(std::span(&scene.originW.x, 3));
  return hash.digits();
}

uint64_t seedFor(const Plan& plan, const std::string& scene, const char* what, size_t item) {
  return std::stoull(hashOf(fmt::format("{} {} {} {}", plan.seed, scene, what, item)).substr(0, 16), nullptr, 16);
}

// A name that no flag takes for something else.
template <typename T>
std::string flagFor(const std::vector<T>& things, size_t i) {
  const std::string& name = things[i].name;
  const bool isPlain =
      !name.empty() && name != "all" && name != "default" && !name.starts_with('#') && !name.starts_with('-');
  return isPlain ? name : fmt::format("#{}", i);
}

class Surveyor {
 public:
  Surveyor(const Plan& plan, const Axes& axes, const SweepScene& axis) : plan_(plan), axes_(axes), axis_(axis) {}

  SceneSurvey survey() {
    const auto traced = std::make_shared<const TracedScene>(openScene(axis_.setup));
    SurveyedScene& scene = survey_.scene;
    scene.hash = hashOfScene(traced->scene);
    scene.triangles = triangleCount(traced->scene);
    scene.diagonal = static_cast<double>(computeBounds(traced->scene).diagonal());
    scene.traced = traced;
    chooseLights(*traced, scene);
    chooseCameras(*traced, scene);
    return std::move(survey_);
  }

 private:
  SetupOptions setupWith(const std::string& light, const std::string& camera) const {
    SetupOptions setup = axis_.setup;
    setup.light = light;
    setup.camera = camera;
    return setup;
  }

  // What `find` refuses here may be in another scene.
  template <typename Find>
  bool tryName(const std::string& where, const Find& find) {
    try {
      find();
      survey_.found.insert(where);
      return true;
    } catch (const UsageError& error) {
      survey_.missing.emplace_back(where,
                                   fmt::format("is in no scene; of {}: {}", axis_.name, oneLine(error.what(), 200)));
      return false;
    }
  }

  template <typename Thing>
  static void add(std::vector<Chosen<Thing>>& places, Chosen<Thing> place) {
    if (std::ranges::find(places, place.name, &Chosen<Thing>::name) == places.end()) places.push_back(std::move(place));
  }

  void addLight(const TracedScene& traced, SurveyedScene& scene, const std::string& name, const std::string& text) {
    add(scene.lights,
        {name, text,
         text.empty() ? defaultLight(traced.tracer) : lightsAsked(setupWith(text, ""), traced.tracer).front()});
  }

  void addCamera(const TracedScene& traced, SurveyedScene& scene, const std::string& name, const std::string& text) {
    add(scene.cameras, {name, text, chooseCamera(setupWith("", text), traced.tracer)});
  }

  // Of the file, or the one above its centre.
  void addDefaultLight(const TracedScene& traced, SurveyedScene& scene, const Parameterization& map) {
    const std::vector<Light>& lights = traced.scene.lights;
    const Light* first = firstLightFor(traced.scene, map);
    if (first == nullptr) return addLight(traced, scene, defaultLight(traced.tracer).name, "");
    addLight(traced, scene, first->name, flagFor(lights, static_cast<size_t>(first - lights.data())));
  }

  // As compare finds it, but written down, since that depends on the light.
  void addDefaultCamera(const TracedScene& traced, SurveyedScene& scene) {
    const std::vector<Camera>& cameras = traced.scene.cameras;
    if (!cameras.empty()) return addCamera(traced, scene, cameras.front().name, flagFor(cameras, 0));
    const Camera camera = chooseCamera(setupWith("", ""), traced.tracer);
    const glm::dmat4 worldFromEye(camera.worldFromEye);
    const glm::dvec3 eye = glm::dvec3(worldFromEye[3]) + traced.scene.originW;
    const glm::dvec3 target = eye - glm::dvec3(worldFromEye[2]) * (0.5 * scene.diagonal);
    addCamera(traced, scene, "default",
              fmt::format("eye:{:.9g},{:.9g},{:.9g},target:{:.9g},{:.9g},{:.9g},fov:{:.6g}", eye.x, eye.y, eye.z,
                          target.x, target.y, target.z, glm::degrees(static_cast<double>(camera.yFovRad))));
  }

  void chooseLights(const TracedScene& traced, SurveyedScene& scene) {
    const std::string& name = axis_.name;
    const std::vector<Light>& lights = traced.scene.lights;
    int drawnBefore = 0;
    for (size_t item = 0; item < plan_.lights.size(); ++item) {
      const PlanPlace& place = plan_.lights[item];
      if (place.random > 0) {
        const std::vector<std::string> drawn =
            randomLights(traced.tracer, place.random, seedFor(plan_, name, "lights", item));
        expectAll(place, name, "lights", drawn.size());
        for (const std::string& text : drawn) addLight(traced, scene, fmt::format("random {}", ++drawnBefore), text);
      } else if (place.name == "all" && !lights.empty()) {
        for (size_t i = 0; i < lights.size(); ++i) addLight(traced, scene, lights[i].name, flagFor(lights, i));
      } else if (place.name == "all" || place.name == "default") {
        if (axes_.maps.empty()) addDefaultLight(traced, scene, usualMapFor(LightType::Point, {}));
        for (const SweepMap& map : axes_.maps) addDefaultLight(traced, scene, *map.map);
      } else if (tryName(place.where, [&] { lightsAsked(setupWith(place.name, ""), traced.tracer); })) {
        addLight(traced, scene, place.name, place.name);
      }
    }
  }

  void chooseCameras(const TracedScene& traced, SurveyedScene& scene) {
    const std::string& name = axis_.name;
    const std::vector<Camera>& cameras = traced.scene.cameras;
    std::vector<Light> lights;
    for (const Chosen<Light>& light : scene.lights) lights.push_back(light.thing);
    int drawnBefore = 0;
    for (size_t item = 0; item < plan_.cameras.size(); ++item) {
      const PlanPlace& place = plan_.cameras[item];
      if (place.random > 0) {
        const std::vector<std::string> drawn = randomCameras(setupWith("", ""), traced.tracer, lights, place.random,
                                                             seedFor(plan_, name, "cameras", item));
        expectAll(place, name, "cameras", drawn.size());
        for (const std::string& text : drawn) addCamera(traced, scene, fmt::format("random {}", ++drawnBefore), text);
      } else if (place.name == "all" && !cameras.empty()) {
        for (size_t i = 0; i < cameras.size(); ++i) addCamera(traced, scene, cameras[i].name, flagFor(cameras, i));
      } else if (place.name == "all" || place.name == "default") {
        addDefaultCamera(traced, scene);
      } else if (tryName(place.where, [&] { chooseCamera(setupWith("", place.name), traced.tracer); })) {
        addCamera(traced, scene, place.name, place.name);
      }
    }
  }

  void expectAll(const PlanPlace& place, const std::string& scene, const char* what, size_t count) const {
    if (count < static_cast<size_t>(place.random))
      plan_.fail(place.where, fmt::format("asks for {} random {}; only {} with something lit to see were found in {}",
                                          place.random, what, count, scene));
  }

  const Plan& plan_;
  const Axes& axes_;
  const SweepScene& axis_;
  SceneSurvey survey_;
};

SceneSurvey surveyOf(const Plan& plan, const Axes& axes, const SweepScene& axis, Store* store,
                     const std::string& program) {
  const std::string key = surveyKey(plan, axes, axis);
  if (store != nullptr)
    if (std::optional<SceneSurvey> known = knownSurvey(*store, key, program, axis.setup.scene))
      return std::move(*known);
  SceneSurvey survey = Surveyor(plan, axes, axis).survey();
  if (store != nullptr) keepSurvey(*store, key, program, axis.setup.scene, survey);
  return survey;
}

}  // namespace

Survey surveyScenes(const Plan& plan, const Axes& axes, Store* store, const std::string& program) {
  Survey survey;
  size_t kept = 0;
  std::set<std::string> found;
  std::vector<std::pair<std::string, std::string>> missing;
  for (size_t at = 0; at < axes.scenes.size(); ++at) {
    throwIfInterrupted();
    SceneSurvey one = surveyOf(plan, axes, axes.scenes[at], store, program);
    SurveyedScene& scene = one.scene;
    scene.at = at;
    kept += scene.traced ? scene.triangles : 0;
    if (kept > kMostTrianglesKept) scene.traced = nullptr;
    for (size_t camera = 0; camera < scene.cameras.size(); ++camera)
      for (size_t light = 0; light < scene.lights.size(); ++light)
        if (!isExcluded(plan, {.scene = axes.scenes[at].name,
                               .light = scene.lights[light].name,
                               .camera = scene.cameras[camera].name}))
          survey.views.push_back({at, camera, light});
    found.merge(one.found);
    missing.insert(missing.end(), one.missing.begin(), one.missing.end());
    survey.scenes.push_back(std::move(scene));
  }
  for (const auto& [where, complaint] : missing)
    if (!found.contains(where)) plan.fail(where, complaint);
  return survey;
}

std::shared_ptr<const TracedScene> tracedScene(const Axes& axes, const SurveyedScene& scene) {
  if (scene.traced) return scene.traced;
  return std::make_shared<const TracedScene>(openScene(axes.scenes[scene.at].setup));
}

bool meets(const Parameterization& map, const Light& light, const std::vector<Chosen<Light>>& all) {
  const LightSupport support = map.supportsLight(light.type);
  if (support != LightSupport::Fallback) return support == LightSupport::Yes;
  return std::ranges::none_of(
      all, [&](const Chosen<Light>& other) { return map.supportsLight(other.thing.type) == LightSupport::Yes; });
}

}  // namespace gnomon
