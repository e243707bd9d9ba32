#include "vsv/media/density.h"

#include "base/error.h"
#include "vsv/media/density_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>

#include <fmt/format.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/GridValidator.h>

namespace gnomon {

struct DensityGrid::Impl {
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
  const nanovdb::NanoGrid<float>* grid = nullptr;
  uint64_t activeVoxels = 0;
  glm::dvec3 centerW{0.0}, centerI{0.0}, lowerI{0.0}, upperI{0.0};
  glm::dmat3 indexFromWorld{1.0}, worldFromIndex{1.0};  // of differences
};

DensityGrid::DensityGrid(const std::string& fileAndGrid, const DensityPlacement& placement)
    : impl_(std::make_unique<Impl>()) {
  const DensityFile file = readDensityFile(fileAndGrid);
  gridName_ = file.gridName;
  impl_->activeVoxels = file.facts.activeVoxels;
  impl_->lowerI = file.facts.lowerI - 1.0;
  impl_->upperI = file.facts.upperI + 1.0;
  impl_->centerI = 0.5 * (impl_->lowerI + impl_->upperI);
  const double turn = glm::radians(placement.turnDegrees);
  const glm::dmat3 turned(glm::dvec3(std::cos(turn), 0.0, -std::sin(turn)), glm::dvec3(0.0, 1.0, 0.0),
                          glm::dvec3(std::sin(turn), 0.0, std::cos(turn)));
  impl_->worldFromIndex = placement.scale * file.facts.worldFromIndex;
  if (placement.turnDegrees != 0.0) impl_->worldFromIndex = turned * impl_->worldFromIndex;
  if (const double det = glm::determinant(impl_->worldFromIndex); !(std::abs(det) > 0.0) || !std::isfinite(det))
    throw fileError(file.path, fmt::format("its grid '{}' has voxels of zero volume", gridName_),
                    "repair its transform");
  impl_->indexFromWorld = glm::inverse(impl_->worldFromIndex);
  impl_->centerW = placement.centerW.value_or(file.facts.centerW) - placement.originW;
  place_ = {.centerW = glm::vec3(impl_->centerW),
            .centerI = glm::vec3(impl_->centerI),
            .indexFromWorld = glm::mat3(impl_->indexFromWorld),
            .lowerI = glm::vec3(impl_->lowerI),
            .upperI = glm::vec3(impl_->upperI)};

  nanovdb::HostBuffer buffer = nanovdb::HostBuffer::create(file.nanoVdb.size());
  std::memcpy(buffer.data(), file.nanoVdb.data(), file.nanoVdb.size());
  impl_->handle = nanovdb::GridHandle<nanovdb::HostBuffer>(std::move(buffer));
  impl_->grid = impl_->handle.grid<float>();
  if (impl_->grid == nullptr || impl_->grid->gridSize() != file.nanoVdb.size() || !nanovdb::isValid(*impl_->grid))
    throw fileError(file.path, fmt::format("its grid '{}' is damaged", gridName_), "repair the file");
}

DensityGrid::~DensityGrid() = default;

double DensityGrid::at(const glm::dvec3& posW) const {
  const glm::dvec3 posI = impl_->centerI + impl_->indexFromWorld * (posW - impl_->centerW);
  if (glm::any(glm::lessThan(posI, impl_->lowerI)) || glm::any(glm::greaterThan(posI, impl_->upperI))) return 0.0;
  const glm::dvec3 lower = glm::floor(posI), upperWeight = posI - lower;
  const auto accessor = impl_->grid->getAccessor();  // keeps the last leaf
  const nanovdb::Coord cell(static_cast<int>(lower.x), static_cast<int>(lower.y), static_cast<int>(lower.z));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const nanovdb::Coord at(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= at[axis] == 1 ? upperWeight[axis] : 1.0 - upperWeight[axis];
    sum += weight * static_cast<double>(accessor.getValue(cell + at));
  }
  return std::max(sum, 0.0);
}

Bounds DensityGrid::boundsW() const {
  const glm::dvec3 half = 0.5 * (impl_->upperI - impl_->lowerI);
  glm::dvec3 reach(0.0);
  for (int axis = 0; axis < 3; ++axis) reach += glm::abs(impl_->worldFromIndex[axis]) * half[axis];
  return {glm::vec3(impl_->centerW - reach), glm::vec3(impl_->centerW + reach)};
}

double DensityGrid::voxelMetres() const {
  return std::min({glm::length(impl_->worldFromIndex[0]), glm::length(impl_->worldFromIndex[1]),
                   glm::length(impl_->worldFromIndex[2])});
}

std::span<const std::byte> DensityGrid::nanoVdb() const {
  return std::as_bytes(std::span(impl_->handle.data(), impl_->handle.size()));
}

uint64_t DensityGrid::activeVoxels() const {
  return impl_->activeVoxels;
}

namespace {

std::span<const std::byte> checkedBytes(const gpu::Device& device, const DensityGrid& grid) {
  const std::span<const std::byte> bytes = grid.nanoVdb();
  const uint64_t most = std::min(device.info().maxStorageBufferBytes, device.info().maxAllocationBytes);
  if (bytes.size() > most)
    throw WorldError(
        fmt::format("--density: grid '{}' takes {} MiB, more than the device's largest buffer, {} MiB; resample it to "
                    "voxels {:.1f} times as large",
                    grid.gridName(), bytes.size() >> 20, most >> 20,
                    std::cbrt(static_cast<double>(bytes.size()) / static_cast<double>(most)) + 0.05));
  return bytes;
}

}  // namespace

DensityBuffers createDensityBuffers(const gpu::Device& device, const DensityGrid& grid) {
  const std::span<const std::byte> bytes = checkedBytes(device, grid);
  DensityBuffers buffers{
      .words = gpu::Buffer(device, {.name = "density", .size = bytes.size()}),
      .place = gpu::createBufferWith(device, "density place", std::vector<glsl::DensityPlace>{grid.place()},
                                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      .boundsW = grid.boundsW(),
      .voxelMetres = grid.voxelMetres()};
  gpu::upload(device, buffers.words, bytes);
  return buffers;
}

}  // namespace gnomon
