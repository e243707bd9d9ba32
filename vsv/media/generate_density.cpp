#include "vsv/media/generate_density.h"

#include "base/error.h"
#include "base/suggest.h"
#include "vsv/vdb_archive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kBlock = static_cast<int>(Leaf::DIM);

// Voxels along the longest side of the bounds: details of a hundredth of a scene, and a few megabytes.
constexpr int kVoxelsAlong = 128;
// Thinner than this nothing is seen of a density; such voxels are left out.
constexpr double kLeastDensity = 1.0 / 1024.0;

// Of a place within the bounds: metres from their lower corner, and their extent.
using DensityAt = std::function<double(const glm::dvec3& at, const glm::dvec3& extent)>;

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A ball that fades to its rim, as wide as three quarters of the shortest side.
double puff(const glm::dvec3& at, const glm::dvec3& extent) {
  const double radius = 0.375 * std::min({extent.x, extent.y, extent.z});
  const double d = glm::length(at - 0.5 * extent) / radius;
  return d < 1.0 ? (1.0 - d * d) * (1.0 - d * d) : 0.0;
}

// Thinner by e every fifth of the height, in sheets of which there are six; gone at the sides and the top, so
// that it ends in no wall.
double fog(const glm::dvec3& at, const glm::dvec3& extent) {
  const double h = at.y / extent.y;
  const double sheets =
      0.7 + 0.3 * std::cos(2.0 * std::numbers::pi * (6.0 * h + 0.3 * std::sin(5.0 * at.x / extent.x)));
  const double toSide =
      std::min({at.x, extent.x - at.x, at.z, extent.z - at.z}) / (0.05 * std::max(extent.x, extent.z));
  return std::exp(-5.0 * h) * sheets * smooth(toSide) * smooth((1.0 - h) / 0.1);
}

// Gradient noise: Perlin, "Improving Noise", SIGGRAPH 2002, with a hash in place of his table, so that every
// seed is another field. In [-1, 1].
class GradientNoise {
 public:
  explicit GradientNoise(uint32_t seed) : seed_(seed) {}

  double at(const glm::dvec3& p) const {
    const glm::dvec3 cell = glm::floor(p), f = p - cell;
    const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 near = glm::mix(1.0 - w, w, offset);
      sum += near.x * near.y * near.z * slope(glm::ivec3(cell + offset), f - offset);
    }
    return sum;
  }

 private:
  // Wang's integer hash, chained: mixes all bits, and is the same on every machine.
  static uint32_t hash(uint32_t x) {
    x = (x ^ 61u) ^ (x >> 16);
    x *= 9u;
    x ^= x >> 4;
    x *= 0x27d4eb2du;
    return x ^ (x >> 15);
  }

  // One of Perlin's twelve gradients, towards the edges of a cube.
  double slope(const glm::ivec3& corner, const glm::dvec3& d) const {
    const uint32_t h =
        hash(static_cast<uint32_t>(corner.x) +
             hash(static_cast<uint32_t>(corner.y) + hash(static_cast<uint32_t>(corner.z) + hash(seed_)))) %
        12u;
    const double u = h < 8u ? d.x : d.y, v = h < 4u ? d.y : d.z;
    return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v);
  }

  uint32_t seed_;
};

// Five octaves of noise, the lowest with a wave of a third of the longest side; what lies above a threshold
// is smoke. Gone at the sides.
double turbulence(const GradientNoise& noise, const glm::dvec3& at, const glm::dvec3& extent) {
  const double wave = std::max({extent.x, extent.y, extent.z}) / 3.0;
  double sum = 0.0, amplitude = 0.5, frequency = 1.0;
  for (int octave = 0; octave < 5; ++octave, amplitude *= 0.5, frequency *= 2.0)
    sum += amplitude * noise.at(at * (frequency / wave) + 17.3 * octave);
  const glm::dvec3 toSide = glm::min(at, extent - at) / (0.08 * extent);
  return 2.0 * smooth((sum + 0.1) / 0.5) * smooth(std::min({toSide.x, toSide.y, toSide.z}));
}

DensityAt densityNamed(const std::string& name, uint32_t seed) {
  if (name == "puff") return puff;
  if (name == "fog") return fog;
  if (name == "turbulence")
    return [noise = GradientNoise(seed)](const glm::dvec3& at, const glm::dvec3& extent) {
      return turbulence(noise, at, extent);
    };
  std::vector<const char*> names;
  for (const GeneratedDensity& density : generatedDensities()) names.push_back(density.name);
  throw UsageError(fmt::format("--density {}: {}", name, chooseFrom(name, fmt::format("{}", fmt::join(names, ", ")))));
}

std::unique_ptr<Leaf> leafOf(const openvdb::Coord& origin, const std::function<double(const openvdb::Coord&)>& at) {
  std::unique_ptr<Leaf> leaf;
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    const double value = at(origin + Leaf::offsetToLocalCoord(n));
    if (value < kLeastDensity) continue;
    if (!leaf) leaf = std::make_unique<Leaf>(origin, 0.0f, false);
    leaf->setValueOn(n, static_cast<float>(value));
  }
  return leaf;
}

}  // namespace

const std::vector<GeneratedDensity>& generatedDensities() {
  static const std::vector<GeneratedDensity> densities = {
      {"puff", "a smooth ball of smoke in the middle, with a known integral"},
      {"fog", "layered ground fog, thinner upwards"},
      {"turbulence", "smoke from five octaves of seeded noise (--seed), detail at every scale"},
  };
  return densities;
}

DensitySummary writeGeneratedDensity(const std::string& name, const Bounds& boundsW, uint32_t seed,
                                     const std::filesystem::path& path) {
  const DensityAt at = densityNamed(name, seed);
  const glm::dvec3 lower(boundsW.lower), diagonal = glm::dvec3(boundsW.upper) - lower;
  const double longest = std::max({diagonal.x, diagonal.y, diagonal.z});
  if (!(longest > 0.0)) throw WorldError("--density: the scene's bounds are empty; choose another with --for");
  const double voxel = longest / kVoxelsAlong;
  // A flat scene is filled as high as an eighth of its length.
  const glm::dvec3 extent = glm::max(diagonal, glm::dvec3(longest / 8.0));
  const glm::ivec3 counts(glm::ceil(extent / voxel));

  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  const openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(voxel);
  transform->postTranslate(openvdb::Vec3d(lower.x, lower.y, lower.z) + openvdb::Vec3d(0.5 * voxel));
  grid->setTransform(transform);
  const auto valueAt = [&](const openvdb::Coord& index) {
    return at((glm::dvec3(index.x(), index.y(), index.z()) + 0.5) * voxel, extent);
  };
  const int slabCount = (counts.x + kBlock - 1) / kBlock;
  std::vector<std::vector<std::unique_ptr<Leaf>>> slabs(slabCount);
  tbb::parallel_for(0, slabCount, [&](int slab) {
    for (int y = 0; y < counts.y; y += kBlock)
      for (int z = 0; z < counts.z; z += kBlock)
        if (auto leaf = leafOf({slab * kBlock, y, z}, valueAt)) slabs[slab].push_back(std::move(leaf));
  });
  for (auto& slab : slabs)
    for (std::unique_ptr<Leaf>& leaf : slab) grid->tree().addLeaf(leaf.release());
  openvdb::MetaMap meta;
  meta.insertMeta("creator", openvdb::StringMetadata("gnomon"));
  meta.insertMeta("gnomon_density", openvdb::StringMetadata(fmt::format("{}, seed {}", name, seed)));
  writeGrids(path, {grid}, meta);
  return {.voxels = grid->activeVoxelCount(), .voxelMetres = voxel};
}

}  // namespace gnomon
