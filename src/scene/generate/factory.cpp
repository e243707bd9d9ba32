// A factory hall driven by a line shaft: close to the 13,284 triangles of Weiskopf & Ertl 2003, figure 7.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr double kHalfX = 9.0, kHalfZ = 6.0, kEaves = 6.0;  // the hall inside, metres
constexpr double kShaftY = 4.6, kShaftZ = -3.6;             // the line shaft runs along x

struct Materials {
  int floor, wall, steel, iron, brass, leather, wood, pipe, machine;
};

Materials addMaterials(Scene& scene) {
  Materials m{};
  m.floor = addMaterial(scene, "floor", {0.42f, 0.40f, 0.37f}, true);
  m.wall = addMaterial(scene, "brick", {0.50f, 0.33f, 0.25f});
  m.steel = addMaterial(scene, "painted steel", {0.26f, 0.34f, 0.32f});
  m.iron = addMaterial(scene, "cast iron", {0.22f, 0.22f, 0.24f});
  m.brass = addMaterial(scene, "brass", {0.62f, 0.46f, 0.16f});
  m.leather = addMaterial(scene, "leather belt", {0.33f, 0.17f, 0.08f}, true);
  m.wood = addMaterial(scene, "wood", {0.52f, 0.35f, 0.18f});
  m.pipe = addMaterial(scene, "red pipe", {0.55f, 0.13f, 0.08f});
  m.machine = addMaterial(scene, "machine green", {0.16f, 0.34f, 0.24f});
  return m;
}

// The back wall is cut by windows; walls are solids 0.3 m thick, sunk into the ground.
void addHall(Scene& scene, const Materials& m) {
  addMesh(scene, groundMesh("floor", m.floor, {-kHalfX, -kHalfZ}, {kHalfX, kHalfZ}));
  // Piers between windows, a sill below and a lintel above: bricks that overlap only inside each other.
  const auto addBlock = [&](const char* name, const glm::dvec3& lower, const glm::dvec3& upper) {
    MeshBuilder block(name, m.wall);
    block.box(lower, upper);
    addMesh(scene, block.build());
  };
  addBlock("sill", {-kHalfX, -0.2, -kHalfZ - 0.3}, {kHalfX, 1.4, -kHalfZ});
  addBlock("lintel", {-kHalfX, 4.9, -kHalfZ - 0.3}, {kHalfX, kEaves + 0.6, -kHalfZ});
  for (int i = 0; i <= 6; ++i) {
    const double x = -kHalfX + 3.0 * i;
    addBlock("pier", {std::max(x - 0.55, -kHalfX), 1.35, -kHalfZ - 0.28},
             {std::min(x + 0.55, kHalfX), 4.95, -kHalfZ - 0.02});
  }
  addBlock("left wall", {-kHalfX - 0.3, -0.2, -kHalfZ - 0.3}, {-kHalfX, kEaves + 0.6, kHalfZ});
}

// A double-T section of the given size, extruded along z.
std::vector<glm::dvec2> girderSection(double width, double height, double flange) {
  const double w = 0.5 * width, h = 0.5 * height, t = 0.5 * flange;
  return {{-w, -h}, {w, -h}, {w, -h + flange}, {t, -h + flange}, {t, h - flange},   {w, h - flange},
          {w, h},   {-w, h}, {-w, h - flange}, {-t, h - flange}, {-t, -h + flange}, {-w, -h + flange}};
}

// Stanchions, cross girders and a lattice between two booms: five trusses across the hall.
void addSteelwork(Scene& scene, const Materials& m) {
  for (int i = 0; i < 5; ++i) {
    const double x = -7.2 + 3.6 * i;
    for (double z : {-kHalfZ + 0.35, kHalfZ - 0.35}) {
      MeshBuilder post("stanchion", m.steel);
      post.place(placed({x, -0.05, z}, {1, 0, 0}, -90.0));
      post.extrude(girderSection(0.26, 0.30, 0.04), 0.0, kEaves - 0.05);
      addMesh(scene, post.build());
    }
    for (double y : {kEaves - 0.1, kEaves + 0.9}) {
      MeshBuilder boom("boom", m.steel);
      boom.placeAt({x, y, 0.0});
      boom.extrude(girderSection(0.22, 0.20, 0.03), -kHalfZ + 0.1, kHalfZ - 0.1);
      addMesh(scene, boom.build());
    }
    // The struts end inside the booms, and keep apart from each other.
    MeshBuilder struts("struts", m.steel);
    for (int k = 0; k < 8; ++k) {
      const double z = -kHalfZ + 0.75 + 1.35 * k;
      struts.cylinder({x, kEaves - 0.06, z}, {x, kEaves + 0.86, z + 0.55}, 0.045, 6);
      struts.cylinder({x, kEaves - 0.06, z + 1.22}, {x, kEaves + 0.86, z + 0.67}, 0.045, 6);
    }
    addMesh(scene, struts.build());
  }
}

// A pulley about x: rim with a raised crown, hub, and spokes, three solids.
void addPulley(Scene& scene, int material, const glm::dvec3& center, double radius, double width) {
  const glm::dmat4 worldFromPulley = placed(center, {0, 0, 1}, -90.0);
  const double w = 0.5 * width;
  MeshBuilder rim("pulley rim", material);
  rim.place(worldFromPulley);
  const std::vector<glm::dvec2> section = {
      {radius - 0.06, -w}, {radius, -w}, {radius + 0.015, 0.0}, {radius, w}, {radius - 0.06, w}};
  constexpr int kSegments = 24;
  const int n = static_cast<int>(section.size());
  // The ring closes on itself along the section too, so it is one loop of faceted rows.
  for (int j = 0; j < n; ++j) {
    const glm::dvec2 a = section[j], b = section[(j + 1) % n];
    const glm::dvec2 out(b.y - a.y, a.x - b.x);
    const auto around = [](int i, double r, double y) {
      const glm::dvec2 c = onCircle(i, kSegments);
      return glm::dvec3(r * c.x, y, -r * c.y);
    };
    rim.loop(
        kSegments, 1, [&](int i, int row) { return row == 0 ? around(i, a.x, a.y) : around(i, b.x, b.y); },
        [&](int i, int) { return around(i, out.x, out.y); });
  }
  addMesh(scene, rim.build());
  MeshBuilder hub("pulley hub", material);
  hub.place(worldFromPulley);
  const glm::dvec2 profile[] = {{0.11, -w - 0.03}, {0.11, w + 0.03}};
  hub.lathe(profile, 20);
  addMesh(scene, hub.build());
  MeshBuilder spokes("pulley spokes", material);
  for (int k = 0; k < 5; ++k) {
    spokes.place(worldFromPulley * placed({0, 0, 0}, {0, 1, 0}, 72.0 * k + 11.0));
    spokes.cylinder({0.10, 0, 0}, {radius - 0.03, 0, 0}, 0.028, 8);
  }
  addMesh(scene, spokes.build());
}

// The belt around two pulleys of the same plane x: an open, two-sided band, 5 mm off the rims.
void addBelt(Scene& scene, int material, const glm::dvec3& upper, double upperRadius, const glm::dvec3& lower,
             double lowerRadius, double width) {
  const glm::dvec2 a(upper.z, upper.y), b(lower.z, lower.y);
  const glm::dvec2 along = glm::normalize(b - a);
  const double ra = upperRadius + 0.02, rb = lowerRadius + 0.02;
  // The outer tangents leave both circles at this angle from the line of centres.
  const double tangent = std::acos((ra - rb) / glm::distance(a, b));
  const double base = std::atan2(along.y, along.x);
  std::vector<glm::dvec2> path;
  constexpr int kArc = 20;
  for (int i = 0; i <= kArc; ++i) {
    const double angle = base + tangent + (2.0 * std::numbers::pi - 2.0 * tangent) * i / kArc;
    path.emplace_back(a + ra * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  for (int i = 0; i <= kArc; ++i) {
    const double angle = base - tangent + 2.0 * tangent * i / kArc;
    path.emplace_back(b + rb * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  const int n = static_cast<int>(path.size());
  const auto point = [&](int i, int j) {
    return glm::dvec3(upper.x + width * (j - 0.5), path[i % n].y, path[i % n].x);
  };
  const auto normal = [&](int i, int) {
    const glm::dvec2 d = glm::normalize(path[(i + 1) % n] - path[(i + n - 1) % n]);
    return glm::dvec3(0.0, d.x, -d.y);
  };
  MeshBuilder belt("belt", material);
  belt.loop(n, 1, point, normal);
  addMesh(scene, belt.build());
}

// A lathe or drill: bed, head, tool post and a driven pulley at its left.
void addMachine(Scene& scene, const Materials& m, double x, uint32_t seed) {
  const double z = -1.9 + 0.3 * hashUnit(seed), height = 0.9;
  MeshBuilder bed("machine bed", m.machine);
  bed.placeAt({x, -0.03, z});
  const glm::dvec2 profile[] = {{-0.45, 0.0},  {0.45, 0.0},   {0.38, 0.12},   {0.26, 0.2},
                                {0.26, 0.62},  {0.36, 0.72},  {0.36, height}, {-0.36, height},
                                {-0.36, 0.72}, {-0.26, 0.62}, {-0.26, 0.2},   {-0.38, 0.12}};
  bed.place(placed({x, -0.03, z}, {0, 1, 0}, 90.0));
  bed.extrude(profile, -0.1, 1.5);
  addMesh(scene, bed.build());
  MeshBuilder head("machine head", m.machine);
  head.box({x, height - 0.05, z - 0.25}, {x + 0.42, height + 0.45, z + 0.25});
  addMesh(scene, head.build());
  MeshBuilder spindle("spindle", m.brass);
  const double axis = height + 0.24;
  spindle.cylinder({x - 0.34, axis, z}, {x + 0.95, axis, z}, 0.05, 18);
  addMesh(scene, spindle.build());
  MeshBuilder chuck("chuck", m.iron);
  chuck.cylinder({x + 0.44, axis, z}, {x + 0.60, axis, z}, 0.17, 24);
  addMesh(scene, chuck.build());
  MeshBuilder tail("tailstock", m.iron);
  tail.box({x + 0.9, height - 0.05, z - 0.16}, {x + 1.25, height + 0.36, z + 0.16});
  addMesh(scene, tail.build());
  const glm::dvec3 driven(x - 0.2, axis, z), driver(x - 0.2, kShaftY, kShaftZ);
  const double driverRadius = 0.34 + 0.12 * hashUnit(seed + 1);
  addPulley(scene, m.iron, driver, driverRadius, 0.2);
  addPulley(scene, m.iron, driven, 0.26, 0.2);
  addBelt(scene, m.leather, driver, driverRadius, driven, 0.26, 0.15);
}

void addTransmission(Scene& scene, const Materials& m) {
  MeshBuilder shaft("line shaft", m.iron);
  shaft.cylinder({-kHalfX + 0.1, kShaftY, kShaftZ}, {kHalfX - 0.2, kShaftY, kShaftZ}, 0.06, 20);
  addMesh(scene, shaft.build());
  for (int i = 0; i < 5; ++i) {
    // A hanger from each truss, with a bearing around the shaft.
    const double x = -7.2 + 3.6 * i;
    MeshBuilder hanger("hanger", m.iron);
    hanger.box({x - 0.06, kShaftY + 0.12, kShaftZ - 0.06}, {x + 0.06, kEaves - 0.15, kShaftZ + 0.06});
    addMesh(scene, hanger.build());
    MeshBuilder bearing("bearing", m.brass);
    bearing.cylinder({x - 0.14, kShaftY, kShaftZ}, {x + 0.14, kShaftY, kShaftZ}, 0.14, 20);
    addMesh(scene, bearing.build());
  }
  for (int i = 0; i < 4; ++i) addMachine(scene, m, -6.0 + 3.6 * i, 7u * static_cast<uint32_t>(i) + 1u);
}

// Pipes along the left and back walls, with bends and flanges.
void addPipes(Scene& scene, const Materials& m) {
  for (int k = 0; k < 3; ++k) {
    const double x = -kHalfX + 0.35, y = 2.4 + 0.45 * k, z = -kHalfZ + 0.35;
    std::vector<glm::dvec3> path = {{x, y, kHalfZ - 0.8}};
    constexpr int kBend = 8;
    for (int i = 0; i <= kBend; ++i) {
      const glm::dvec2 c(std::cos(0.5 * std::numbers::pi * i / kBend), std::sin(0.5 * std::numbers::pi * i / kBend));
      path.emplace_back(x + 0.4 * (1.0 - c.x), y, z + 0.4 * (1.0 - c.y));
    }
    path.emplace_back(kHalfX - 0.4, y, z);
    MeshBuilder pipe("pipe", k == 1 ? m.brass : m.pipe);
    pipe.tube(path, 0.09, 14);
    addMesh(scene, pipe.build());
    for (int i = 0; i < 5; ++i) {
      MeshBuilder flange("flange", m.iron);
      const double fx = -kHalfX + 2.2 + 3.6 * i;
      flange.cylinder({fx, y, z}, {fx + 0.08, y, z}, 0.15, 12);
      addMesh(scene, flange.build());
    }
  }
}

// A crate of boards: a core, and a frame of boards proud of it, each its own closed box that does not touch others.
void addCrate(Scene& scene, const Materials& m, const glm::dvec3& foot, double turn, double size) {
  MeshBuilder crate("crate", m.wood);
  crate.place(placed(foot, {0, 1, 0}, turn));
  const double h = 0.5 * size, board = 0.09 * size, proud = 0.025;
  crate.box({-h, 0.0, -h}, {h, size, h});
  addMesh(scene, crate.build());
  MeshBuilder boards("crate boards", m.wood);
  boards.place(placed(foot, {0, 1, 0}, turn));
  for (int side = 0; side < 4; ++side) {
    boards.place(placed(foot, {0, 1, 0}, turn + 90.0 * side));
    // Boards begin 2 mm inside the core, so that only their proud faces show.
    boards.box({-h + 0.03, 0.04, h - 0.002}, {h - 0.03, 0.04 + board, h + proud});
    boards.box({-h + 0.03, size - 0.04 - board, h - 0.002}, {h - 0.03, size - 0.04, h + proud});
    boards.box({-h + 0.03, 0.05 + board, h - 0.002}, {-h + 0.03 + board, size - 0.05 - board, h + proud});
    boards.box({h - 0.03 - board, 0.05 + board, h - 0.002}, {h - 0.03, size - 0.05 - board, h + proud});
  }
  addMesh(scene, boards.build());
}

void addGoods(Scene& scene, const Materials& m) {
  const double spots[][4] = {{3.6, 1.6, 18.0, 1.0},  {4.9, 2.0, -9.0, 0.9},   {4.2, 3.3, 33.0, 1.1},
                             {-4.6, 2.9, 12.0, 1.0}, {-3.3, 3.5, -27.0, 0.8}, {6.8, 0.9, 5.0, 1.2}};
  for (const auto& spot : spots) addCrate(scene, m, {spot[0], -0.02, spot[1]}, spot[2], spot[3]);
  addCrate(scene, m, {4.2, 0.985, 1.85}, 40.0, 0.7);
  // Steel drums with two hoops.
  for (int k = 0; k < 6; ++k) {
    const glm::dvec2 profile[] = {{0.30, 0.0},  {0.30, 0.29}, {0.32, 0.31}, {0.30, 0.33},
                                  {0.30, 0.60}, {0.32, 0.62}, {0.30, 0.64}, {0.30, 0.92}};
    MeshBuilder drum("drum", k % 3 == 0 ? m.pipe : m.steel);
    drum.placeAt(
        {-6.9 + 0.75 * (k % 3) + 0.1 * hashUnit(100u + k), -0.02, 2.2 + 0.8 * (k / 3) + 0.1 * hashUnit(200u + k)});
    drum.lathe(profile, 20);
    addMesh(scene, drum.build());
  }
  // Bar stock laid on two trestles.
  for (double x : {-0.9, 1.6}) {
    MeshBuilder trestle("trestle", m.wood);
    trestle.placeAt({x, 0, 2.4});
    trestle.box({-0.06, 0.60, -0.5}, {0.06, 0.72, 0.5});
    trestle.box({-0.05, -0.02, -0.42}, {0.05, 0.598, -0.32});
    trestle.box({-0.05, -0.02, 0.32}, {0.05, 0.598, 0.42});
    addMesh(scene, trestle.build());
  }
  for (int k = 0; k < 7; ++k) {
    MeshBuilder bar("bar stock", k % 2 ? m.iron : m.brass);
    const double z = 2.04 + 0.12 * k;
    bar.cylinder({-1.6 + 0.3 * hashUnit(300u + k), 0.765, z}, {2.2 + 0.4 * hashUnit(400u + k), 0.765, z}, 0.042, 12);
    addMesh(scene, bar.build());
  }
}

}  // namespace

Scene makeFactory() {
  Scene scene;
  scene.name = "factory";
  const Materials m = addMaterials(scene);
  addHall(scene, m);
  addSteelwork(scene, m);
  addTransmission(scene, m);
  addPipes(scene, m);
  addGoods(scene, m);
  // From the open right front, over the eaves: the paper's light is directional.
  addDirectionalLight(scene, "skylight", {-0.50f, -0.72f, -0.48f}, 3.0f);
  addPointLight(scene, "hanging lamp", {1.2f, 4.2f, 1.4f}, 90.0f);
  addPointLight(scene, "work lamp", {-3.9f, 2.6f, 0.3f}, 30.0f);
  addCamera(scene, "hall", {5.6f, 3.0f, 5.2f}, {-1.4f, 2.0f, -2.4f}, 58.0f);
  addCamera(scene, "line shaft", {-0.6f, 3.6f, 0.9f}, {-3.6f, 3.5f, -3.6f}, 55.0f);
  addCamera(scene, "goods", {0.6f, 2.3f, 6.4f}, {2.6f, 0.6f, 1.6f}, 50.0f);
  return scene;
}

}  // namespace gnomon
