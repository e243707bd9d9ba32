#include "scene/generate/compose.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

int addMaterial(Scene& scene, std::string name, glm::vec3 linearColor, bool doubleSided) {
  Material material;
  material.name = std::move(name);
  material.baseColor = glm::vec4(linearColor, 1.0f);
  material.doubleSided = doubleSided;
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

void addMesh(Scene& scene, Mesh mesh) {
  Instance instance;
  instance.name = mesh.name;
  instance.mesh = static_cast<int>(scene.meshes.size());
  scene.instances.push_back(std::move(instance));
  scene.meshes.push_back(std::move(mesh));
}

void addPointLight(Scene& scene, std::string name, glm::vec3 posW, float candela) {
  Light light;
  light.name = std::move(name);
  light.positionW = posW;
  light.intensity = candela;
  scene.lights.push_back(std::move(light));
}

void addDirectionalLight(Scene& scene, std::string name, glm::vec3 directionW, float lux) {
  Light light;
  light.name = std::move(name);
  light.type = LightType::Directional;
  light.directionW = glm::vec3(glm::normalize(glm::dvec3(directionW)));
  light.intensity = lux;
  scene.lights.push_back(std::move(light));
}

void addSpotLight(Scene& scene, std::string name, glm::vec3 posW, glm::vec3 targetW, float outerDegrees,
                  float candela) {
  Light light;
  light.name = std::move(name);
  light.type = LightType::Spot;
  light.positionW = posW;
  light.directionW = glm::vec3(glm::normalize(glm::dvec3(targetW) - glm::dvec3(posW)));
  light.outerConeRad = glm::radians(outerDegrees);
  light.innerConeRad = 0.8f * light.outerConeRad;
  light.intensity = candela;
  scene.lights.push_back(std::move(light));
}

void addCamera(Scene& scene, std::string name, glm::vec3 eyeW, glm::vec3 targetW, float fovDegrees) {
  scene.cameras.push_back(lookAt(std::move(name), eyeW, targetW, glm::radians(fovDegrees)));
}

double hashUnit(uint32_t seed) {
  seed = (seed ^ 61u) ^ (seed >> 16);
  seed *= 9u;
  seed ^= seed >> 4;
  seed *= 0x27d4eb2du;
  seed ^= seed >> 15;
  return seed / 4294967296.0;
}

Mesh groundMesh(std::string name, int material, glm::dvec2 lowerXz, glm::dvec2 upperXz, double y) {
  MeshBuilder builder(std::move(name), material);
  builder.quad({lowerXz.x, y, upperXz.y}, {upperXz.x, y, upperXz.y}, {upperXz.x, y, lowerXz.y},
               {lowerXz.x, y, lowerXz.y});
  return builder.build();
}

glm::dmat4 placed(const glm::dvec3& origin, const glm::dvec3& axis, double degrees) {
  return glm::rotate(glm::translate(glm::dmat4(1.0), origin), glm::radians(degrees), axis);
}

}  // namespace gnomon
