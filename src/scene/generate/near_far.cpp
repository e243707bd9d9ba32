// One lamp, a box within arm's reach and a wall across the hall: Dou et al. 2014, figure 7.
//
//        lamp *                                              | wall, turned away from the lamp
//       ====  slats, 2 cm above                              |# ledges, 30 cm before it
//      [box]  1 m from the lamp                              |
//   -----------------------------  40 m of floor  ---------------
//
// A texel is forty times as wide on the wall as on the box, so a bias in metres that is enough for the wall
// steps over the slats.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

namespace gnomon {

Scene makeNearFar() {
  Scene scene;
  scene.name = "near-far";
  const int stone = addMaterial(scene, "stone", {0.56f, 0.55f, 0.52f}, true);
  const int plaster = addMaterial(scene, "plaster", {0.62f, 0.60f, 0.55f});
  const int wood = addMaterial(scene, "wood", {0.52f, 0.30f, 0.14f});
  const int iron = addMaterial(scene, "iron", {0.24f, 0.26f, 0.29f});
  addMesh(scene, groundMesh("floor", stone, {-9.0, -44.0}, {9.0, 4.0}));

  MeshBuilder box("box", wood);
  box.place(placed({0.9, 0.0, -0.6}, {0, 1, 0}, 28.0));
  box.box({-0.4, 0.0, -0.4}, {0.4, 1.1, 0.4});
  addMesh(scene, box.build());

  MeshBuilder slats("slats", iron);
  slats.place(placed({0.9, 1.12, -0.6}, {0, 1, 0}, 28.0));
  for (int i = 0; i < 7; ++i) {
    const double x = -0.36 + 0.12 * i;
    slats.box({x - 0.02, 0.0, -0.36}, {x + 0.02, 0.01, 0.36});
  }
  addMesh(scene, slats.build());

  // Light falls on it at 60 to 70 degrees from its normal.
  MeshBuilder wall("wall", plaster);
  wall.place(placed({0.0, 0.0, -40.0}, {0, 1, 0}, 62.0));
  wall.box({-9.0, 0.0, -0.4}, {9.0, 6.0, 0.0});
  addMesh(scene, wall.build());

  MeshBuilder ledges("ledges", iron);
  ledges.place(placed({0.0, 0.0, -40.0}, {0, 1, 0}, 62.0));
  for (int i = 0; i < 5; ++i) {
    const double y = 0.9 + 1.0 * i;
    ledges.box({-8.0, y, 0.3}, {8.0, y + 0.3, 0.6});
  }
  addMesh(scene, ledges.build());

  addPointLight(scene, "lamp", {0.0f, 2.0f, 0.0f}, 40.0f);
  addCamera(scene, "box", {1.9f, 2.1f, 0.9f}, {0.9f, 1.05f, -0.6f}, 45.0f);
  addCamera(scene, "wall", {-4.0f, 3.2f, -26.0f}, {-0.5f, 2.6f, -40.0f}, 45.0f);
  return scene;
}

}  // namespace gnomon
