// Where an occluder meets its receiver, and where it has no thickness.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace gnomon {

// Everything touches the floor exactly: the undersides lie in its plane y = 0, the spheres touch it in a
// point. A bias that is too large detaches the shadows ("peter-panning").
Scene makeContact() {
  Scene scene;
  scene.name = "contact";
  const int floor = addMaterial(scene, "floor", {0.58f, 0.56f, 0.52f}, true);
  const int wood = addMaterial(scene, "wood", {0.52f, 0.30f, 0.14f});
  const int blue = addMaterial(scene, "blue lacquer", {0.10f, 0.22f, 0.48f});
  const int red = addMaterial(scene, "red lacquer", {0.55f, 0.09f, 0.07f});
  const int chalk = addMaterial(scene, "chalk", {0.78f, 0.76f, 0.70f});
  addMesh(scene, groundMesh("floor", floor, {-5.0, -5.0}, {5.0, 5.0}));

  const auto addBox = [&](const char* name, int material, glm::dvec2 xz, double turn, glm::dvec3 size) {
    MeshBuilder builder(name, material);
    builder.place(placed({xz.x, 0, xz.y}, {0, 1, 0}, turn));
    builder.box({-0.5 * size.x, 0, -0.5 * size.z}, {0.5 * size.x, size.y, 0.5 * size.z});
    addMesh(scene, builder.build());
  };
  addBox("cube", wood, {-1.7, -0.4}, 24.0, {1.0, 1.0, 1.0});
  addBox("tall box", chalk, {0.3, -2.0}, -12.0, {0.6, 2.2, 0.6});
  addBox("slab", wood, {1.6, 1.6}, 38.0, {1.6, 0.12, 0.9});
  addBox("thin plate", blue, {2.5, -0.6}, 65.0, {1.2, 0.9, 0.04});

  const auto addSphere = [&](const char* name, int material, glm::dvec2 xz, double radius, int segments) {
    MeshBuilder builder(name, material);
    builder.sphere({xz.x, radius, xz.y}, radius, segments, segments / 2);
    addMesh(scene, builder.build());
  };
  addSphere("ball", red, {-0.2, 1.1}, 0.55, 64);
  addSphere("marble", blue, {-1.6, 1.9}, 0.2, 32);
  addSphere("coarse ball", chalk, {-3.0, 1.2}, 0.45, 12);

  const auto addColumn = [&](const char* name, int material, glm::dvec2 xz, double bottom, double top, double height) {
    MeshBuilder builder(name, material);
    builder.placeAt({xz.x, 0, xz.y});
    const glm::dvec2 profile[2] = {{bottom, 0.0}, {top, height}};
    builder.lathe(profile, 48);
    addMesh(scene, builder.build());
  };
  addColumn("cylinder", blue, {1.1, -0.2}, 0.35, 0.35, 1.1);
  addColumn("cone", red, {-2.9, -1.9}, 0.6, 0.0, 1.5);
  addColumn("disc", chalk, {0.6, 2.7}, 0.5, 0.5, 0.06);

  addPointLight(scene, "lamp", {-2.6f, 3.4f, 1.6f}, 32.0f);
  addDirectionalLight(scene, "sun", {0.75f, -0.62f, -0.25f}, 2.5f);
  addSpotLight(scene, "spot", {-3.2f, 4.2f, 2.8f}, {0.0f, 0.0f, 0.0f}, 36.0f, 70.0f);
  addCamera(scene, "table", {2.6f, 3.3f, 6.2f}, {-0.2f, 0.35f, 0.0f}, 45.0f);
  addCamera(scene, "low", {1.6f, 0.7f, 3.6f}, {-0.8f, 0.4f, 0.0f}, 50.0f);
  return scene;
}

namespace {

// A lattice of 16 x 16 texels: opaque bars, clear between; nearest sampling makes its holes exact rectangles.
void addFenceTexture(Scene& scene) {
  constexpr int kSide = 16;
  glsl::TextureInfo info{};
  info.firstTexel = static_cast<uint32_t>(scene.texels.size());
  info.width = info.height = kSide;
  info.wrapS = info.wrapT = glsl::kWrapRepeat;
  info.filterMode = glsl::kTexFilterNearest;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool bar = x < 4 || y < 4;
      scene.texels.push_back(bar ? 0xff4f8fb4u : 0u);
    }
  }
  scene.textures.push_back(info);
}

// A leaf blade along x, pointed at both ends, bent down and folded along its rib.
Mesh leafMesh(const std::string& name, int material, const glm::dmat4& worldFromLeaf, double length, double width) {
  MeshBuilder builder(name, material);
  builder.place(worldFromLeaf);
  builder.sheet(16, 6, [=](double s, double t) {
    // Not quite pointed: a width of 0 would leave the tips without a normal.
    const double half = 0.5 * width * (0.03 + 0.97 * std::sin(std::numbers::pi * s) * (1.2 - 0.4 * s));
    const double across = 2.0 * t - 1.0;
    return glm::dvec3(length * s,
                      0.12 * length * std::sin(2.2 * s) + 0.25 * half * across * across - 0.2 * length * s * s,
                      -half * across);
  });
  return builder.build();
}

}  // namespace

// Sheets have no back face for second-depth maps to store, and no thickness for a midpoint to lie in.
Scene makeSheets() {
  Scene scene;
  scene.name = "sheets";
  const int floor = addMaterial(scene, "earth", {0.34f, 0.27f, 0.20f}, true);
  const int leaf = addMaterial(scene, "leaf", {0.16f, 0.42f, 0.10f}, true);
  const int stem = addMaterial(scene, "stem", {0.30f, 0.34f, 0.14f});
  const int pot = addMaterial(scene, "terracotta", {0.58f, 0.24f, 0.12f});
  const int cloth = addMaterial(scene, "cloth", {0.66f, 0.62f, 0.54f}, true);
  const int fence = addMaterial(scene, "fence", {1.0f, 1.0f, 1.0f}, true);
  addFenceTexture(scene);
  scene.materials[fence].baseColorTexture = 0;
  scene.materials[fence].alphaMode = AlphaMode::Mask;

  addMesh(scene, groundMesh("floor", floor, {-4.0, -4.0}, {4.0, 4.0}));

  MeshBuilder potBuilder("pot", pot);
  potBuilder.placeAt({0.0, -0.02, 0.0});
  const glm::dvec2 potProfile[] = {{0.36, 0.0},  {0.52, 0.62}, {0.60, 0.62}, {0.60, 0.76},
                                   {0.50, 0.76}, {0.47, 0.66}, {0.0, 0.66}};
  potBuilder.lathe(potProfile, 48);
  addMesh(scene, potBuilder.build());

  MeshBuilder stemBuilder("stem", stem);
  const glm::dvec3 stemPath[] = {{0.0, 0.55, 0.0}, {0.02, 1.0, 0.01}, {-0.02, 1.5, 0.03}, {0.03, 2.1, -0.02}};
  stemBuilder.tube(stemPath, 0.035, 16);
  addMesh(scene, stemBuilder.build());
  for (int k = 0; k < 9; ++k) {
    const double height = 0.95 + 0.13 * k, turn = 137.5 * k;
    const glm::dmat4 worldFromLeaf =
        placed({0.0, height, 0.0}, {0, 1, 0}, turn) * placed({0.05, 0, 0}, {0, 0, 1}, 28.0 + 3.0 * k);
    addMesh(scene, leafMesh(fmt::format("leaf {}", k), leaf, worldFromLeaf, 1.15 - 0.07 * k, 0.42 - 0.02 * k));
  }

  // A square of lattice, 8 x 5 cells, standing free behind the pot.
  Mesh lattice = groundMesh("fence", fence, {0.0, 0.0}, {1.0, 1.0});
  const glm::vec3 corners[4] = {
      {-2.6f, 0.05f, -1.1f}, {0.6f, 0.05f, -2.2f}, {0.6f, 2.05f, -2.2f}, {-2.6f, 2.05f, -1.1f}};
  const glm::vec3 normal(glm::normalize(glm::cross(glm::dvec3(corners[1] - corners[0]), glm::dvec3(0, 1, 0))));
  for (int k = 0; k < 4; ++k) {
    lattice.positions[k] = corners[k];
    lattice.normals[k] = normal;
    lattice.uvs[k] *= glm::vec2(8.0f, 5.0f);
  }
  addMesh(scene, std::move(lattice));

  MeshBuilder clothBuilder("cloth", cloth);
  clothBuilder.sheet(40, 24, [](double s, double t) {
    const double fold = 0.10 * std::sin(17.0 * s) + 0.05 * std::sin(29.0 * s + 1.0);
    return glm::dvec3(1.5 + 1.3 * s, 0.12 + 1.7 * t, -1.3 + 0.9 * s + fold * (1.25 - t));
  });
  addMesh(scene, clothBuilder.build());

  MeshBuilder stone("stone", pot);
  stone.sphere({1.25, 0.28, 1.1}, 0.32, 40, 20);
  addMesh(scene, stone.build());

  addPointLight(scene, "lamp", {1.6f, 3.1f, 1.9f}, 26.0f);
  addDirectionalLight(scene, "sun", {-0.45f, -0.75f, -0.35f}, 2.5f);
  addCamera(scene, "plant", {2.3f, 2.5f, 5.0f}, {-0.1f, 0.85f, -0.4f}, 42.0f);
  addCamera(scene, "leaves", {1.0f, 2.5f, 1.9f}, {0.0f, 1.4f, 0.0f}, 50.0f);
  return scene;
}

}  // namespace gnomon
