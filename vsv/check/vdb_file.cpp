#include "vsv/check/vdb_file.h"

#include "base/error.h"
#include "vsv/check/volume_grid_impl.h"
#include "vsv/vdb_archive.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <openvdb/tools/Prune.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
constexpr int kBlock = static_cast<int>(Leaf::DIM);

// The voxel that holds a point of the world.
struct VoxelAt {
  int alpha = 0, theta = 0, phi = 0;
  bool inside = false;  // the volume's ranges cover the point
};

VoxelAt voxelAt(const glsl::EpipolarGrid& grid, const glsl::LightFrame& frame, const glm::vec3& posW) {
  const glsl::EpipolarPoint point = glsl::epipolarFromLight(grid.eyeDistance, glsl::lightFromWorld(frame, posW));
  const float alpha = (point.alpha - grid.alphaLower) / grid.alphaStep;
  const float theta = glsl::thetaSteps(grid, point.theta);
  const float phi = (point.phi - grid.phiLower) / grid.phiStep;
  const auto within = [](float steps, int count) { return steps >= 0.0f && steps < static_cast<float>(count); };
  VoxelAt at;
  at.inside = within(alpha, grid.alphaCount) && within(theta, grid.thetaCount) && within(phi, grid.phiCount);
  if (at.inside) at = {static_cast<int>(alpha), static_cast<int>(theta), static_cast<int>(phi), true};
  return at;
}

// Voxels of the density have their centres at index * size.
struct Box {
  openvdb::Coord lower, upper;  // both within
};

Box boxOf(const Bounds& boundsW, double voxel) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = static_cast<int>(std::lround(boundsW.lower[axis] / voxel));
    box.upper[axis] = static_cast<int>(std::lround(boundsW.upper[axis] / voxel));
  }
  return box;
}

std::unique_ptr<Leaf> shadowOfBlock(const DenseVolume& volume, const glsl::LightFrame& frame, const Box& box,
                                    const openvdb::Coord& origin, double voxel) {
  std::unique_ptr<Leaf> leaf;
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    const openvdb::Coord at = origin + Leaf::offsetToLocalCoord(n);
    if (openvdb::Coord::lessThan(at, box.lower) || openvdb::Coord::lessThan(box.upper, at)) continue;
    const glm::vec3 posW(glm::dvec3(at.x(), at.y(), at.z()) * voxel);
    const VoxelAt v = voxelAt(volume.grid, frame, posW);
    if (!v.inside || !volume.bit(v.alpha, v.theta, v.phi)) continue;
    if (!leaf) leaf = std::make_unique<Leaf>(origin, 0.0f, false);
    leaf->setValueOn(n, 1.0f);
  }
  return leaf;
}

openvdb::FloatGrid::Ptr densityGrid(const DenseVolume& volume, const glsl::LightFrame& frame, const Box& box,
                                    double voxel) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  const auto blockOf = [](int index) { return index & ~(kBlock - 1); };
  const int first = blockOf(box.lower.x());
  const int slabCount = (blockOf(box.upper.x()) - first) / kBlock + 1;
  std::vector<std::vector<std::unique_ptr<Leaf>>> slabs(slabCount);
  tbb::parallel_for(0, slabCount, [&](int slab) {
    for (int y = blockOf(box.lower.y()); y <= box.upper.y(); y += kBlock)
      for (int z = blockOf(box.lower.z()); z <= box.upper.z(); z += kBlock)
        if (auto leaf = shadowOfBlock(volume, frame, box, {first + slab * kBlock, y, z}, voxel))
          slabs[slab].push_back(std::move(leaf));
  });
  for (auto& slab : slabs) {
    for (std::unique_ptr<Leaf>& leaf : slab) {
      if (leaf->isDense())
        grid->tree().addTile(1, leaf->origin(), 1.0f, true);
      else
        grid->tree().addLeaf(leaf.release());
    }
    slab.clear();
  }
  openvdb::tools::prune(grid->tree());
  return grid;
}

openvdb::Vec3d vec3d(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

openvdb::MetaMap notes(const glsl::EpipolarGrid& grid, const VdbOptions& options) {
  openvdb::MetaMap meta;
  const glm::vec3 eyeW = options.frame.originW + options.frame.backW * grid.eyeDistance;
  meta.insertMeta("gnomon_light", openvdb::Vec3DMetadata(vec3d(options.frame.originW)));
  meta.insertMeta("gnomon_eye", openvdb::Vec3DMetadata(vec3d(eyeW)));
  meta.insertMeta("gnomon_lower", openvdb::Vec3DMetadata({grid.alphaLower, grid.thetaLower, grid.phiLower}));
  meta.insertMeta("gnomon_step", openvdb::Vec3DMetadata({grid.alphaStep, grid.thetaStep, grid.phiStep}));
  meta.insertMeta("gnomon_counts", openvdb::Vec3IMetadata({grid.alphaCount, grid.thetaCount, grid.phiCount}));
  meta.insertMeta("gnomon_source", openvdb::StringMetadata(options.source));
  meta.insertMeta("gnomon_command", openvdb::StringMetadata(options.command));
  meta.insertMeta("creator", openvdb::StringMetadata("gnomon"));
  return meta;
}

double sizeOf(const Bounds& boundsW, double voxel) {
  double count = 1.0;
  for (int axis = 0; axis < 3; ++axis)
    count *= (static_cast<double>(boundsW.upper[axis]) - boundsW.lower[axis]) / voxel + 1.0;
  return count;
}

}  // namespace

double meanVoxel(const glsl::EpipolarGrid& grid, const glsl::LightFrame& frame, const Bounds& boundsW) {
  // The share of the bounds that the volume covers, from 64^3 points; at least an eighth, so that a narrow
  // volume in a large scene does not ask for the whole scene in fine voxels.
  constexpr int kPoints = 64;
  constexpr double kLeastShare = 1.0 / 8.0;
  const glm::vec3 step = (boundsW.upper - boundsW.lower) / static_cast<float>(kPoints);
  const uint64_t inside = tbb::parallel_reduce(
      tbb::blocked_range<int>(0, kPoints), uint64_t{0},
      [&](const tbb::blocked_range<int>& range, uint64_t count) {
        for (int x = range.begin(); x != range.end(); ++x)
          for (int y = 0; y < kPoints; ++y)
            for (int z = 0; z < kPoints; ++z)
              if (voxelAt(grid, frame, boundsW.lower + (glm::vec3(x, y, z) + 0.5f) * step).inside) ++count;
        return count;
      },
      std::plus<>());
  const double share = std::max(static_cast<double>(inside) / std::pow(kPoints, 3), kLeastShare);
  // A flat scene has no volume, but shadows between its floor and the light's height.
  const glm::dvec3 extent = glm::max(glm::dvec3(boundsW.upper - boundsW.lower), glm::dvec3(boundsW.diagonal() / 256.0));
  const double voxels = std::min(static_cast<double>(voxelCount(grid)), kMeanVoxelLimit);
  return std::cbrt(extent.x * extent.y * extent.z * share / voxels);
}

VdbSummary writeVdb(const std::filesystem::path& path, const VolumeGrid& mask, const DenseVolume& volume,
                    const VdbOptions& options) {
  startOpenVdb();
  const double voxel =
      options.voxelMetres > 0.0 ? options.voxelMetres : meanVoxel(volume.grid, options.frame, options.boundsW);
  const double count = sizeOf(options.boundsW, voxel);
  if (!(count <= kMostDensityVoxels))
    throw UsageError(fmt::format("--vdb-voxel {}: would make {:.3g} voxels in the scene's bounds; use {:.3g} or more",
                                 voxel, count, voxel * std::cbrt(count / kMostDensityVoxels) * 1.01));
  VdbSummary summary{.voxelMetres = voxel};
  const openvdb::FloatGrid::Ptr density = densityGrid(volume, options.frame, boxOf(options.boundsW, voxel), voxel);
  summary.densityVoxels = density->activeVoxelCount();
  const openvdb::MetaMap meta = notes(volume.grid, options);
  const openvdb::MaskGrid::Ptr epipolar = mask.impl().grid->copy();  // shares the tree, not the metadata
  for (auto it = meta.beginMeta(); it != meta.endMeta(); ++it) {
    density->insertMeta(it->first, *it->second);
    epipolar->insertMeta(it->first, *it->second);
  }
  writeGrids(path, {density, epipolar}, meta);
  summary.fileBytes = std::filesystem::file_size(path);
  return summary;
}

}  // namespace gnomon
