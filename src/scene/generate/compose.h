#pragma once
// What the generated scenes share: adding materials, meshes and lights, and a hash for their small irregularities.

#include "scene/mesh_builder.h"
#include "scene/scene.h"

#include <string>

namespace gnomon {

// Opaque. A double-sided material is for open sheets, the other for solids. Returns its index.
int addMaterial(Scene& scene, std::string name, glm::vec3 linearColor, bool doubleSided = false);

// Adds the mesh with one instance that has its name and no transform.
void addMesh(Scene& scene, Mesh mesh);

void addPointLight(Scene& scene, std::string name, glm::vec3 posW, float candela);

// Shines along `directionW`, which need not be unit.
void addDirectionalLight(Scene& scene, std::string name, glm::vec3 directionW, float lux);

// Shines from posW to targetW; the full cone is `outerDegrees` wide to each side of the axis.
void addSpotLight(Scene& scene, std::string name, glm::vec3 posW, glm::vec3 targetW, float outerDegrees, float candela);

// Looks from eyeW to targetW, with a vertical field of view in degrees.
void addCamera(Scene& scene, std::string name, glm::vec3 eyeW, glm::vec3 targetW, float fovDegrees);

// In [0, 1), the same on every machine: Thomas Wang's 32-bit mix of a running number.
double hashUnit(uint32_t seed);

// A horizontal open rectangle at height y that faces up, two triangles.
Mesh groundMesh(std::string name, int material, glm::dvec2 lowerXz, glm::dvec2 upperXz, double y = 0.0);

// A turn by `degrees` about an axis, then a move to `origin`.
glm::dmat4 placed(const glm::dvec3& origin, const glm::dvec3& axis, double degrees);

}  // namespace gnomon
