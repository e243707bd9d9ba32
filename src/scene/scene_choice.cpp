#include "scene/scene_choice.h"

#include "base/check.h"
#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

constexpr size_t kMostNamesTold = 12;

// A mesh of several primitives is "name 0", "name 1" and so on.
bool isPartOf(const std::string& mesh, const std::string& name) {
  return mesh.size() > name.size() + 1 && mesh.starts_with(name + " ") &&
         mesh.find_first_not_of("0123456789", name.size() + 1) == std::string::npos;
}

bool isCalled(const Scene& scene, const Instance& instance, const std::string& name) {
  const std::string& mesh = scene.meshes[instance.mesh].name;
  if (instance.name == name || mesh == name || isPartOf(mesh, name)) return true;
  return !instance.path.empty() && ("/" + instance.path + "/").find("/" + name + "/") != std::string::npos;
}

// Of nodes, their ancestors and meshes, each once.
std::vector<std::string> namesIn(const Scene& scene) {
  std::set<std::string> names;
  for (const Instance& instance : scene.instances) {
    names.insert(instance.name);
    names.insert(scene.meshes[instance.mesh].name);
    for (size_t at = 0; at < instance.path.size();) {
      const size_t end = std::min(instance.path.find('/', at), instance.path.size());
      names.insert(instance.path.substr(at, end - at));
      at = end + 1;
    }
  }
  names.erase("");
  return {names.begin(), names.end()};
}

[[noreturn]] void refuse(const Scene& scene, const char* flag, const std::string& name) {
  std::vector<std::string> names = namesIn(scene);
  const std::string nearest = nearestName(name, names);
  const size_t left = names.size() - std::min(names.size(), kMostNamesTold);
  names.resize(names.size() - left);
  throw UsageError(fmt::format("{} {}: the scene has no node or mesh of this name; {} has {}{}", flag, name,
                               nearest.empty() ? "it" : fmt::format("did you mean {}? It", nearest),
                               fmt::join(names, ", "), left == 0 ? "" : fmt::format(" and {} more", left)));
}

void setCasting(Scene& scene, const char* flag, const std::vector<std::string>& names, bool casts) {
  for (const std::string& name : names) {
    size_t count = 0;
    for (Instance& instance : scene.instances) {
      if (!isCalled(scene, instance, name)) continue;
      instance.casts = casts;
      ++count;
    }
    if (count == 0) refuse(scene, flag, name);
    scene.notes.push_back(fmt::format("{} {}: {} of {} instances {}", flag, name, count, scene.instances.size(),
                                      casts ? "may cast a shadow" : "cast no shadow"));
  }
}

Bounds boundsOf(const Scene& scene, const Instance& instance) {
  Bounds bounds{.lower = glm::vec3(INFINITY), .upper = glm::vec3(-INFINITY)};
  for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
    const glm::vec3 posW(instance.worldFromMesh * glm::vec4(position, 1.0f));
    bounds.lower = glm::min(bounds.lower, posW);
    bounds.upper = glm::max(bounds.upper, posW);
  }
  return bounds;
}

bool holds(const Bounds& bounds, const glm::vec3& place) {
  return glm::all(glm::greaterThanEqual(place, bounds.lower)) && glm::all(glm::lessThanEqual(place, bounds.upper));
}

// Somebody looks or shines out of it: what a solid hides from the light would be the wall that it lights.
bool isRoom(const Scene& scene, const Instance& instance) {
  const Bounds bounds = boundsOf(scene, instance);
  return std::ranges::any_of(
             scene.lights,
             [&](const Light& l) { return l.type != LightType::Directional && holds(bounds, l.positionW); }) ||
         std::ranges::any_of(scene.cameras,
                             [&](const Camera& c) { return holds(bounds, glm::vec3(c.worldFromEye[3])); });
}

void chooseSolids(Scene& scene, Solids solids) {
  if (solids == Solids::File) return;
  std::vector<bool> isLeft(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances)
    if (solids == Solids::Auto && !isLeft[instance.mesh] && scene.meshes[instance.mesh].closed &&
        scene.materials[scene.meshes[instance.mesh].material].doubleSided && isRoom(scene, instance))
      isLeft[instance.mesh] = true;
  size_t count = 0;
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    if (!mesh.closed || isLeft[i] || !scene.materials[mesh.material].doubleSided) continue;
    mesh.solidAnyway = true;
    ++count;
  }
  if (count > 0)
    scene.notes.push_back(
        fmt::format("{} closed meshes that the file calls doubleSided count as solids (--solids)", count));
}

}  // namespace

const std::vector<std::string>& solidsNames() {
  static const std::vector<std::string> names = {"file", "closed", "auto"};
  return names;
}

const char* solidsName(Solids solids) {
  return solidsNames()[static_cast<size_t>(solids)].c_str();
}

Solids parseSolids(const std::string& name) {
  const auto found = std::ranges::find(solidsNames(), name);
  GNOMON_CHECK(found != solidsNames().end());
  return static_cast<Solids>(found - solidsNames().begin());
}

void applyChoice(Scene& scene, const SceneChoice& choice) {
  if (!choice.casters.empty())
    for (Instance& instance : scene.instances) instance.casts = false;
  setCasting(scene, "--casters", choice.casters, true);
  setCasting(scene, "--exclude", choice.excluded, false);
  if (std::ranges::none_of(scene.instances, &Instance::casts))
    throw UsageError("--casters and --exclude leave nothing to cast a shadow; name fewer meshes to --exclude");
  chooseSolids(scene, choice.solids);
}

}  // namespace gnomon
