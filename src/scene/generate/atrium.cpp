// A columned two-storey court with arches and curtains: the class of scene of Dou et al. 2014 (Sponza).
//
//        z                  the court is open to the sky; around it runs a gallery on each storey,
//   +---------------+       between the row of columns and the outer wall
//   | o o o o o o o |
//   | o           o |       court 16 x 8 m, gallery 2.5 m wide, storeys 4.4 m high
//   | o o o o o o o |
//   +---------------+ x

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr double kCourtX = 8.0, kCourtZ = 4.0;  // half extents of the court, to the columns' axes, metres
constexpr double kGallery = 2.5;                // metres from the columns' axes to the outer wall
constexpr double kStorey = 4.4;                 // metres from floor to floor
constexpr double kSlab = 0.4;                   // thickness of the gallery's floor and of its roof
constexpr double kSpring = 2.6;                 // height at which the arches spring
constexpr int kBaysX = 6, kBaysZ = 3;           // of equal width

struct Materials {
  int floor, stone, wall, pale, wood, red, green, blue, clay;
};

Materials addMaterials(Scene& scene) {
  Materials m{};
  m.floor = addMaterial(scene, "flagstones", {0.46f, 0.42f, 0.36f}, true);
  m.stone = addMaterial(scene, "limestone", {0.66f, 0.58f, 0.45f});
  m.wall = addMaterial(scene, "plaster", {0.60f, 0.46f, 0.32f});
  m.pale = addMaterial(scene, "marble", {0.76f, 0.73f, 0.67f});
  m.wood = addMaterial(scene, "wood", {0.28f, 0.16f, 0.08f});
  m.red = addMaterial(scene, "red curtain", {0.52f, 0.06f, 0.05f}, true);
  m.green = addMaterial(scene, "green curtain", {0.08f, 0.30f, 0.12f}, true);
  m.blue = addMaterial(scene, "blue curtain", {0.07f, 0.13f, 0.40f}, true);
  m.clay = addMaterial(scene, "clay", {0.50f, 0.23f, 0.12f});
  return m;
}

// The outer walls, the gallery's floor and its roof: each a closed frame of four boxes that do not touch.
void addShell(Scene& scene, const Materials& m) {
  const double x = kCourtX + kGallery, z = kCourtZ + kGallery, top = 2 * kStorey + 0.5;
  addMesh(scene, groundMesh("floor", m.floor, {-x, -z}, {x, z}));
  // The outline of a rectangle with a rectangular hole is one polygon with a slit; four boxes are simpler,
  // and a solid each, so that they may touch.
  const auto frame = [&](const char* name, int material, double innerX, double innerZ, double outerX, double outerZ,
                         double y0, double y1) {
    const glm::dvec3 boxes[4][2] = {{{-outerX, y0, innerZ}, {outerX, y1, outerZ}},
                                    {{-outerX, y0, -outerZ}, {outerX, y1, -innerZ}},
                                    {{innerX, y0, -innerZ}, {outerX, y1, innerZ}},
                                    {{-outerX, y0, -innerZ}, {-innerX, y1, innerZ}}};
    for (int k = 0; k < 4; ++k) {
      MeshBuilder builder(fmt::format("{} {}", name, k), material);
      builder.box(boxes[k][0], boxes[k][1]);
      addMesh(scene, builder.build());
    }
  };
  frame("wall", m.wall, x, z, x + 0.4, z + 0.4, -0.2, top);
  // Slabs reach 2 cm into the wall, and 0.5 m beyond the columns' axes into the court.
  frame("gallery", m.stone, kCourtX - 0.5, kCourtZ - 0.5, x + 0.02, z + 0.02, kStorey - kSlab, kStorey);
  frame("roof", m.stone, kCourtX - 0.6, kCourtZ - 0.6, x + 0.02, z + 0.02, 2 * kStorey - kSlab, 2 * kStorey);
}

void addColumn(Scene& scene, int material, const glm::dvec3& foot, double height, int segments) {
  // Plinth and capital turn with the shaft; the top ends 2 cm inside the arches' band.
  const double s = 0.24;
  const std::vector<glm::dvec2> profile = {{1.6 * s, -0.05},         {1.6 * s, 0.14},         {1.35 * s, 0.22},
                                           {1.0 * s, 0.28},          {1.03 * s, 1.1},         {0.85 * s, height - 0.4},
                                           {1.5 * s, height - 0.12}, {1.6 * s, height - 0.1}, {1.6 * s, height + 0.02}};
  MeshBuilder builder("column", material);
  builder.placeAt(foot);
  builder.lathe(profile, segments);
  addMesh(scene, builder.build());
}

struct Side {
  glm::dvec3 corner;  // foot of the column at the left end, seen from the court
  double turn;        // degrees about y, so that +x runs along the side
  int bays;
};

constexpr double kBay = 2 * kCourtX / kBaysX;  // metres; both sides have bays of this width
static_assert(2 * kCourtZ / kBaysZ == kBay);

const Side kSides[4] = {{{-kCourtX, 0, -kCourtZ}, 0.0, kBaysX},
                        {{kCourtX, 0, -kCourtZ}, -90.0, kBaysZ},
                        {{kCourtX, 0, kCourtZ}, 180.0, kBaysX},
                        {{-kCourtX, 0, kCourtZ}, 90.0, kBaysZ}};

// A wall with a round opening a bay, in the plane z = 0, beginning `overhang` before the first column's axis.
std::vector<glm::dvec2> arcadePolygon(int bays, double overhang, double spring, double top, int segments) {
  const double radius = 0.5 * kBay - 0.30;
  std::vector<glm::dvec2> polygon = {{-overhang, top}, {-overhang, spring}};
  for (int bay = 0; bay < bays; ++bay) {
    for (int i = 0; i <= segments; ++i) {
      const double angle = std::numbers::pi * (1.0 - static_cast<double>(i) / segments);
      const double rise = i == 0 || i == segments ? 0.0 : 0.9 * radius * std::sin(angle);
      polygon.emplace_back((bay + 0.5) * kBay + radius * std::cos(angle), spring + rise);
    }
  }
  polygon.emplace_back(bays * kBay + overhang, spring);
  polygon.emplace_back(bays * kBay + overhang, top);
  return polygon;
}

// The wall above the columns, one solid a side. At the corners of the court two of them cross.
void addArcade(Scene& scene, const Materials& m, const Side& side, int storey) {
  MeshBuilder builder("arcade", m.stone);
  builder.place(placed(side.corner + glm::dvec3(0, storey * kStorey, 0), {0, 1, 0}, side.turn));
  // Reaches 2 cm into the slab above; ends short of its neighbour's face, so that no two faces share a plane.
  builder.extrude(arcadePolygon(side.bays, 0.2, kSpring, kStorey - kSlab + 0.02, 12), -0.22, 0.22);
  addMesh(scene, builder.build());
}

struct Bay {
  glm::dvec3 origin;  // foot of the column at the left end, seen from the court
  double turn;        // degrees about y, so that +x runs along the side
};

std::vector<Bay> baysOf(const Side& side) {
  std::vector<Bay> bays;
  const glm::dmat4 worldFromSide = placed(side.corner, {0, 1, 0}, side.turn);
  for (int i = 0; i < side.bays; ++i)
    bays.push_back({glm::dvec3(worldFromSide * glm::dvec4(i * kBay, 0, 0, 1)), side.turn});
  return bays;
}

// A balustrade between the upper columns: a rail and turned balusters.
void addBalustrade(Scene& scene, const Materials& m, const Bay& bay) {
  const glm::dvec3 foot = bay.origin + glm::dvec3(0, kStorey, 0);
  MeshBuilder rail("rail", m.pale);
  rail.place(placed(foot, {0, 1, 0}, bay.turn));
  rail.box({0.3, 0.78, -0.09}, {kBay - 0.3, 0.9, 0.09});
  addMesh(scene, rail.build());
  MeshBuilder builder("balusters", m.pale);
  const std::vector<glm::dvec2> profile = {{0.065, -0.03}, {0.045, 0.1}, {0.075, 0.3}, {0.035, 0.58}, {0.06, 0.80}};
  const int count = 4;
  for (int i = 0; i < count; ++i) {
    const double x = 0.45 + (kBay - 0.9) * i / (count - 1);
    builder.place(placed(foot, {0, 1, 0}, bay.turn) * placed({x, 0, 0}, {0, 1, 0}, 0.0));
    builder.lathe(profile, 6);
  }
  addMesh(scene, builder.build());
}

// Hangs in the bay from a rod below the springing, gathered into folds that deepen downward.
void addCurtain(Scene& scene, int material, int rodMaterial, const Bay& bay, int storey, uint32_t seed) {
  const glm::dmat4 worldFromBay = placed(bay.origin + glm::dvec3(0, storey * kStorey, 0), {0, 1, 0}, bay.turn);
  MeshBuilder cloth("curtain", material);
  cloth.place(worldFromBay);
  const double phase = 6.28 * hashUnit(seed), left = 0.42, width = kBay - 0.84;
  cloth.sheet(30, 8, [=](double s, double t) {
    const double depth = 0.05 + 0.07 * (1.0 - t);
    const double z = depth * std::sin(34.0 * s + phase) + 0.05 * std::sin(9.0 * s + 2.0 * phase) * (1.0 - t);
    return glm::dvec3(left + width * s, 0.95 + (kSpring - 1.12) * t, -0.05 + z);
  });
  addMesh(scene, cloth.build());
  MeshBuilder rod("rod", rodMaterial);
  rod.place(worldFromBay);
  rod.cylinder({0.1, kSpring - 0.1, -0.05}, {kBay - 0.1, kSpring - 0.1, -0.05}, 0.025, 8);
  addMesh(scene, rod.build());
}

void addFurniture(Scene& scene, const Materials& m) {
  const std::vector<glm::dvec2> urn = {{0.26, -0.02}, {0.28, 0.10}, {0.16, 0.16}, {0.13, 0.30},
                                       {0.34, 0.62},  {0.40, 0.86}, {0.33, 1.00}, {0.42, 1.06},
                                       {0.42, 1.12},  {0.34, 1.12}, {0.30, 0.98}, {0.0, 0.90}};
  for (int k = 0; k < 4; ++k) {
    MeshBuilder builder("urn", m.clay);
    builder.placeAt({k % 2 ? 5.4 : -5.4, 0, k < 2 ? -2.1 : 2.1});
    builder.lathe(urn, 16);
    addMesh(scene, builder.build());
  }
  // A fountain in the middle: basin, stem, bowl.
  const std::vector<glm::dvec2> basin = {{1.5, -0.02}, {1.5, 0.10},  {1.35, 0.14}, {1.35, 0.45}, {1.5, 0.52},
                                         {1.5, 0.58},  {1.25, 0.58}, {1.2, 0.25},  {0.0, 0.25}};
  MeshBuilder pool("basin", m.pale);
  pool.lathe(basin, 24);
  addMesh(scene, pool.build());
  const std::vector<glm::dvec2> bowl = {{0.22, 0.20}, {0.14, 0.40}, {0.11, 0.95}, {0.2, 1.05}, {0.62, 1.22},
                                        {0.66, 1.3},  {0.58, 1.3},  {0.12, 1.14}, {0.07, 1.5}, {0.0, 1.6}};
  MeshBuilder stem("bowl", m.pale);
  stem.lathe(bowl, 20);
  addMesh(scene, stem.build());
  for (int k = 0; k < 4; ++k) {
    MeshBuilder bench("bench", m.wood);
    bench.placeAt({k % 2 ? 3.3 : -3.3, 0, k < 2 ? -3.0 : 3.0});
    bench.box({-0.9, 0.40, -0.2}, {0.9, 0.48, 0.2});
    bench.box({-0.8, -0.02, -0.16}, {-0.7, 0.395, 0.16});
    bench.box({0.7, -0.02, -0.16}, {0.8, 0.395, 0.16});
    addMesh(scene, bench.build());
  }
}

}  // namespace

Scene makeAtrium() {
  Scene scene;
  scene.name = "atrium";
  const Materials m = addMaterials(scene);
  addShell(scene, m);
  const int curtains[3] = {m.red, m.green, m.blue};
  uint32_t curtainCount = 0;
  for (const Side& side : kSides) {
    for (int storey : {0, 1}) addArcade(scene, m, side, storey);
    const std::vector<Bay> bays = baysOf(side);
    for (size_t i = 0; i < bays.size(); ++i) {
      addColumn(scene, m.stone, bays[i].origin, kSpring, 14);
      addColumn(scene, m.pale, bays[i].origin + glm::dvec3(0, kStorey, 0), kSpring, 12);
      addBalustrade(scene, m, bays[i]);
      // On the long sides every second bay below has a curtain.
      if (side.bays != kBaysX || i % 2 == 0) continue;
      addCurtain(scene, curtains[curtainCount % 3], m.wood, bays[i], 0, curtainCount);
      ++curtainCount;
    }
  }
  addFurniture(scene, m);
  addPointLight(scene, "lantern", {-1.9f, 2.9f, 0.6f}, 60.0f);
  addPointLight(scene, "brazier", {5.2f, 1.5f, 0.4f}, 25.0f);
  addDirectionalLight(scene, "sun", {0.35f, -0.85f, -0.40f}, 3.0f);
  addCamera(scene, "court", {7.0f, 2.1f, 2.3f}, {-2.6f, 2.6f, -1.3f}, 62.0f);
  addCamera(scene, "gallery", {-8.9f, 6.1f, 3.3f}, {2.5f, 1.6f, -1.8f}, 62.0f);
  addCamera(scene, "fountain", {-4.6f, 1.5f, 2.9f}, {0.6f, 1.2f, -1.0f}, 52.0f);
  return scene;
}

}  // namespace gnomon
