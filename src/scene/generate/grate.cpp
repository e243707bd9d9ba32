// A lamp behind bars: long thin shadows that fan out over floor and walls, and shafts in a participating medium.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <fmt/format.h>

namespace gnomon {

//  +-----------+  the room is open to +z and to the top; the grate stands across it at z = -2,
//  |     *     |  the lamp behind it at z = -2.9
//  |-|-|-|-|-|-|
//  |           |
Scene makeGrate() {
  Scene scene;
  scene.name = "grate";
  const int wall = addMaterial(scene, "brick", {0.52f, 0.40f, 0.32f}, true);
  const int floor = addMaterial(scene, "concrete", {0.50f, 0.49f, 0.47f}, true);
  const int iron = addMaterial(scene, "iron", {0.18f, 0.18f, 0.20f});
  const int barrel = addMaterial(scene, "oak", {0.40f, 0.22f, 0.10f});
  constexpr double kHalf = 3.5, kBack = -4.0, kFront = 5.0, kHeight = 3.6;  // metres
  MeshBuilder room("walls", wall);
  room.quad({-kHalf, 0, kBack}, {kHalf, 0, kBack}, {kHalf, kHeight, kBack}, {-kHalf, kHeight, kBack});
  room.quad({-kHalf, 0, kFront}, {-kHalf, 0, kBack}, {-kHalf, kHeight, kBack}, {-kHalf, kHeight, kFront});
  room.quad({kHalf, 0, kBack}, {kHalf, 0, kFront}, {kHalf, kHeight, kFront}, {kHalf, kHeight, kBack});
  addMesh(scene, room.build());
  addMesh(scene, groundMesh("floor", floor, {-kHalf, kBack}, {kHalf, kFront}));

  constexpr double kGrateZ = -2.0, kTop = 3.2;
  constexpr int kBars = 14;
  for (int i = 0; i < kBars; ++i) {
    const double x = kHalf * (2.0 * (i + 0.5) / kBars - 1.0);
    MeshBuilder bar(fmt::format("bar {}", i), iron);
    bar.cylinder({x, -0.04, kGrateZ}, {x, kTop, kGrateZ}, 0.045, 20);
    addMesh(scene, bar.build());
  }
  for (double y : {0.35, 1.75, kTop - 0.16}) {
    MeshBuilder rail("rail", iron);
    rail.box({-kHalf + 0.02, y - 0.04, kGrateZ - 0.07}, {kHalf - 0.02, y + 0.04, kGrateZ + 0.07});
    addMesh(scene, rail.build());
  }
  // A barrel in front, for a broad shadow among the thin ones.
  MeshBuilder cask("barrel", barrel);
  cask.placeAt({1.3, -0.02, 0.2});
  const glm::dvec2 staves[] = {{0.33, 0.0}, {0.40, 0.22}, {0.43, 0.47}, {0.40, 0.72}, {0.33, 0.94}};
  cask.lathe(staves, 36);
  addMesh(scene, cask.build());
  MeshBuilder crate("crate", barrel);
  crate.place(placed({-1.5, -0.02, -0.3}, {0, 1, 0}, 31.0));
  crate.box({-0.35, 0.0, -0.35}, {0.35, 0.7, 0.35});
  addMesh(scene, crate.build());

  addPointLight(scene, "lamp", {0.35f, 2.1f, -2.9f}, 26.0f);
  addDirectionalLight(scene, "moon", {0.30f, -0.75f, -0.55f}, 0.6f);
  addSpotLight(scene, "beam", {0.35f, 2.1f, -2.9f}, {0.2f, 0.4f, 1.5f}, 38.0f, 90.0f);
  addCamera(scene, "cell", {-1.9f, 2.7f, 6.3f}, {0.25f, 0.9f, -1.2f}, 48.0f);
  addCamera(scene, "bars", {2.6f, 1.5f, 2.2f}, {-0.4f, 1.2f, -2.2f}, 55.0f);
  return scene;
}

}  // namespace gnomon
