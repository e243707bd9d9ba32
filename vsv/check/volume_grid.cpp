#include "vsv/check/volume_grid_impl.h"

#include <array>
#include <vector>

#include <openvdb/tools/Prune.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

using Tree = openvdb::MaskTree;
using Leaf = Tree::LeafNodeType;
using BlockMask = Leaf::NodeMaskType;

constexpr int kBlock = static_cast<int>(Leaf::DIM);  // voxels a side
static_assert(kBlock == 8, "a word of a leaf's mask is eight rows of eight phi bits");

// The bits of a block: word x of a leaf's mask holds bit z of row y at 8 y + z, and (x, y, z) is
// (alpha, theta, phi), so that a row is a byte of the volume's word. Voxels beyond the volume are lit.
BlockMask blockMask(const DenseVolume& volume, const openvdb::Coord& origin) {
  BlockMask mask;
  for (int x = 0; x < kBlock && origin.x() + x < volume.grid.alphaCount; ++x) {
    uint64_t rows = 0;
    for (int y = 0; y < kBlock && origin.y() + y < volume.grid.thetaCount; ++y) {
      const uint64_t word = volume.words[volume.wordIndex(origin.x() + x, origin.y() + y, origin.z() / kWordBits)];
      rows |= (word >> (origin.z() % kWordBits) & 0xffu) << (8 * y);
    }
    mask.getWord<uint64_t>(x) = rows;
  }
  return mask;
}

struct Blocks {
  std::vector<openvdb::Coord> whole;
  std::vector<std::unique_ptr<Leaf>> partial;
};

Blocks blocksOfSlab(const DenseVolume& volume, int alpha) {
  Blocks blocks;
  for (int theta = 0; theta < volume.grid.thetaCount; theta += kBlock) {
    for (int phi = 0; phi < volume.grid.phiCount; phi += kBlock) {
      const openvdb::Coord origin(alpha, theta, phi);
      const BlockMask mask = blockMask(volume, origin);
      if (mask.isOff()) continue;
      if (mask.isOn()) {
        blocks.whole.push_back(origin);
        continue;
      }
      blocks.partial.push_back(std::make_unique<Leaf>(origin));
      blocks.partial.back()->setValueMask(mask);
    }
  }
  return blocks;
}

// World units of the mask are radians: a voxel's centre lies at its alpha, theta, phi.
openvdb::math::Transform::Ptr anglesFromIndex(const glsl::EpipolarGrid& grid) {
  const openvdb::Vec3d step(grid.alphaStep, grid.thetaStep, grid.phiStep);
  const openvdb::Vec3d lower(grid.alphaLower, grid.thetaLower, grid.phiLower);
  return std::make_shared<openvdb::math::Transform>(
      openvdb::math::MapBase::Ptr(new openvdb::math::ScaleTranslateMap(step, lower + 0.5 * step)));
}

}  // namespace

void startOpenVdb() {
  openvdb::initialize();
}

VolumeGrid::VolumeGrid(const DenseVolume& volume) : impl_(std::make_unique<Impl>()) {
  startOpenVdb();
  impl_->epipolar = volume.grid;
  impl_->grid = openvdb::MaskGrid::create();
  impl_->grid->setName("shadow_epipolar");
  impl_->grid->setTransform(anglesFromIndex(volume.grid));

  const int slabCount = (volume.grid.alphaCount + kBlock - 1) / kBlock;
  std::vector<Blocks> slabs(slabCount);
  tbb::parallel_for(0, slabCount, [&](int slab) { slabs[slab] = blocksOfSlab(volume, slab * kBlock); });
  Tree& tree = impl_->grid->tree();
  for (Blocks& blocks : slabs) {
    for (const openvdb::Coord& origin : blocks.whole) tree.addTile(1, origin, true, true);
    for (std::unique_ptr<Leaf>& leaf : blocks.partial) tree.addLeaf(leaf.release());
  }
  openvdb::tools::prune(tree);
}

VolumeGrid::~VolumeGrid() = default;
VolumeGrid::VolumeGrid(VolumeGrid&&) noexcept = default;
VolumeGrid& VolumeGrid::operator=(VolumeGrid&&) noexcept = default;

bool VolumeGrid::occluded(int alpha, int theta, int phi) const {
  return impl_->grid->tree().isValueOn(openvdb::Coord(alpha, theta, phi));
}

uint64_t VolumeGrid::activeVoxels() const {
  return impl_->grid->activeVoxelCount();
}

uint64_t VolumeGrid::memoryBytes() const {
  return impl_->grid->memUsage();
}

uint64_t VolumeGrid::tileCount() const {
  return impl_->grid->tree().activeTileCount();
}

uint64_t VolumeGrid::leafCount() const {
  return impl_->grid->tree().leafCount();
}

GridDifference compareGrids(const VolumeGrid& first, const VolumeGrid& second) {
  const Tree& a = first.impl().grid->tree();
  const Tree& b = second.impl().grid->tree();
  Tree both(a), onlyFirst(a), onlySecond(b);
  both.topologyIntersection(b);
  onlyFirst.topologyDifference(b);
  onlySecond.topologyDifference(a);
  return {both.activeVoxelCount(), onlyFirst.activeVoxelCount(), onlySecond.activeVoxelCount()};
}

}  // namespace gnomon
