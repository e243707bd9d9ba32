#pragma once
// Scenes of a few triangles, written down where a test can reason about them. Frame: W, metres, y up.

#include "scene/scene.h"

#include <glm/glm.hpp>

namespace gnomon::test {

// One opaque two-sided material, no mesh yet.
Scene emptyScene();

// Each adds a mesh and one instance of it, and returns the instance's index.
int addTriangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
// Corners in order around it; triangles (a, b, c) and (a, c, d).
int addQuad(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d);
int addBox(Scene& scene, glm::dvec3 lower, glm::dvec3 upper);
int addSphere(Scene& scene, glm::dvec3 center, double radius, int rings, int segments);

// A floor at the height y, of the half extent, around the origin.
int addFloor(Scene& scene, double y, double halfExtent);

// The same mesh once more, under a matrix.
int addInstance(Scene& scene, int mesh, const glm::mat4& worldFromMesh);

// Turns every mesh about the origin and moves it: corners are rounded to float after that.
void moveAll(Scene& scene, const glm::dmat4& newFromOld);

// An alpha-masked material: a texture of 2x2 texels, opaque but for the one at uv in [0,0.5)^2.
int addMaskMaterial(Scene& scene);

}  // namespace gnomon::test
