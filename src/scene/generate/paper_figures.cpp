// Weiskopf & Ertl, "Shadow Mapping Based on Dual Depth Layers", 2003: figures 5 and 6. Figure 7 is factory.cpp.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

namespace gnomon {

// An L-shaped solid above a greenish surface, light from right above. Its wings form a vertical crease that
// faces the camera: the left wing's inner side faces the light, but near the crease the right wing shades it.
Scene makeLshape() {
  Scene scene;
  scene.name = "lshape";
  const int ground = addMaterial(scene, "greenish ground", {0.28f, 0.48f, 0.26f}, true);
  const int body = addMaterial(scene, "ochre", {0.68f, 0.52f, 0.30f});
  addMesh(scene, groundMesh("ground", ground, {-6.0, -6.0}, {6.0, 6.0}));
  MeshBuilder builder("L", body);
  // The polygon's (x, y) lies as (x, -z): a quarter turn about x.
  builder.place(placed({-0.9, 0.5, -0.9}, {1, 0, 0}, -90.0));
  const glm::dvec2 outline[] = {{0, 0}, {0, -2.6}, {0.8, -2.6}, {0.8, -0.8}, {2.6, -0.8}, {2.6, 0}};
  builder.extrude(outline, 0.0, 1.7);
  addMesh(scene, builder.build());
  addDirectionalLight(scene, "right above", {-0.57f, -0.80f, 0.22f}, 3.0f);
  addPointLight(scene, "lamp", {3.4f, 5.0f, -1.3f}, 90.0f);
  addCamera(scene, "figure 5", {4.2f, 4.4f, 4.8f}, {-0.1f, 0.75f, 0.0f}, 36.0f);
  addCamera(scene, "crease", {2.2f, 2.6f, 2.4f}, {-0.1f, 1.2f, -0.1f}, 45.0f);
  return scene;
}

// Two interlinked tori over a ground: curved silhouettes everywhere, thick and thin as seen from the light.
Scene makeDoubleTorus() {
  Scene scene;
  scene.name = "double-torus";
  const int ground = addMaterial(scene, "ground", {0.52f, 0.50f, 0.46f}, true);
  const int lying = addMaterial(scene, "copper", {0.62f, 0.28f, 0.13f});
  const int standing = addMaterial(scene, "steel", {0.28f, 0.36f, 0.50f});
  addMesh(scene, groundMesh("ground", ground, {-5.0, -5.0}, {5.0, 5.0}));
  // Each ring's tube runs through the middle of the other's hole.
  MeshBuilder first("lying torus", lying);
  first.place(placed({-0.5, 1.45, 0.0}, {0, 0, 1}, 14.0));
  first.torus({0, 0, 0}, 1.0, 0.3, 96, 48);
  addMesh(scene, first.build());
  MeshBuilder second("standing torus", standing);
  second.place(placed({0.5, 1.6, 0.0}, {1, 0.12, 0}, 82.0));
  second.torus({0, 0, 0}, 1.0, 0.3, 96, 48);
  addMesh(scene, second.build());
  addDirectionalLight(scene, "right above", {-0.45f, -0.85f, -0.28f}, 3.0f);
  addPointLight(scene, "lamp", {2.2f, 4.4f, 1.5f}, 60.0f);
  addCamera(scene, "figure 6", {1.9f, 3.5f, 5.2f}, {-0.2f, 1.1f, 0.0f}, 40.0f);
  addCamera(scene, "link", {0.4f, 2.6f, 2.6f}, {0.0f, 1.5f, 0.0f}, 45.0f);
  return scene;
}

}  // namespace gnomon
