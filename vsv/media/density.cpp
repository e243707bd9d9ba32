#include "vsv/media/density.h"

#include "base/error.h"
#include "vsv/vdb_archive.h"

#include "shared/media_pass.glsl"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nanovdb/util/OpenToNanoVDB.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

struct Named {
  std::string path, grid;  // no grid: the only one
};

// A colon ends the path only behind ".vdb".
Named splitName(const std::string& fileAndGrid) {
  const size_t colon = fileAndGrid.rfind(".vdb:");
  if (colon == std::string::npos) return {fileAndGrid, ""};
  return {fileAndGrid.substr(0, colon + 4), fileAndGrid.substr(colon + 5)};
}

std::string namesIn(openvdb::io::File& file) {
  std::vector<std::string> names;
  for (auto it = file.beginName(); it != file.endName(); ++it) names.push_back(it.gridName());
  return fmt::format("{}", fmt::join(names, ", "));
}

openvdb::GridBase::Ptr readNamed(openvdb::io::File& file, const Named& named) {
  std::string name = named.grid;
  if (name.empty()) {
    auto it = file.beginName();
    if (it == file.endName()) throw fileError(named.path, "it has no grid", "use another file");
    name = it.gridName();
    if (++it != file.endName())
      throw fileError(named.path, "it has several grids",
                      fmt::format("name one, as in {}:{}; it has {}", named.path, name, namesIn(file)));
  } else if (!file.hasGrid(name)) {
    throw fileError(named.path, fmt::format("it has no grid '{}'", name), fmt::format("choose from {}", namesIn(file)));
  }
  return file.readGrid(name);
}

openvdb::GridBase::Ptr readGrid(const Named& named) {
  openvdb::initialize();
  std::error_code failure;
  if (!fs::is_regular_file(named.path, failure)) throw fileError(named.path, "there is no such file", "check the name");
  try {
    openvdb::io::File file(named.path);
    file.open(/*delayLoad=*/false);
    return readNamed(file, named);
  } catch (const WorldError&) {
    throw;
  } catch (const std::exception& error) {  // OpenVDB's own, and what a broken file makes the library throw
    throw fileError(named.path, fmt::format("it cannot be read as OpenVDB ({})", openVdbMessage(error)),
                    "use a complete .vdb file");
  }
}

openvdb::FloatGrid::Ptr checkedGrid(const Named& named) {
  const openvdb::GridBase::Ptr base = readGrid(named);
  const auto complain = [&](const std::string& what, const char* remedy) {
    return fileError(named.path, fmt::format("its grid '{}' {}", base->getName(), what), remedy);
  };
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
  if (!grid) throw complain(fmt::format("holds {}", base->valueType()), "a density is a grid of floats");
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    throw complain("is a level set", "convert it to a fog volume first");
  if (!grid->transform().isLinear())
    throw complain("has a transform that is not affine", "resample it to equal voxels");
  if (grid->activeVoxelCount() == 0) throw complain("is empty", "use another grid");
  if (!std::isfinite(grid->background())) throw complain("has values that are not finite", "repair the file");
  for (auto it = grid->cbeginValueAll(); it; ++it)
    if (!std::isfinite(*it)) throw complain("has values that are not finite", "repair the file");
  return grid;
}

glm::dvec3 toGlm(const openvdb::Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

struct DensityGrid::Impl {
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
  const nanovdb::NanoGrid<float>* grid = nullptr;
  uint64_t activeVoxels = 0;
  glm::dvec3 centerW{0.0}, centerI{0.0}, lowerI{0.0}, upperI{0.0};
  glm::dmat3 indexFromWorld{1.0}, worldFromIndex{1.0};  // of differences
};

DensityGrid::DensityGrid(const std::string& fileAndGrid, const DensityPlacement& placement)
    : impl_(std::make_unique<Impl>()) {
  const Named named = splitName(fileAndGrid);
  const openvdb::FloatGrid::Ptr grid = checkedGrid(named);
  gridName_ = grid->getName();
  impl_->activeVoxels = grid->activeVoxelCount();
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  impl_->lowerI = toGlm(box.min().asVec3d()) - 1.0;
  impl_->upperI = toGlm(box.max().asVec3d()) + 1.0;
  impl_->centerI = 0.5 * (impl_->lowerI + impl_->upperI);

  const openvdb::math::Transform& transform = grid->transform();
  const auto fileFromIndex = [&](const glm::dvec3& index) {
    return toGlm(transform.indexToWorld(openvdb::Vec3d(index.x, index.y, index.z)));
  };
  const glm::dvec3 origin = fileFromIndex(glm::dvec3(0.0));
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    impl_->worldFromIndex[axis] = placement.scale * (fileFromIndex(unit) - origin);
  }
  if (const double det = glm::determinant(impl_->worldFromIndex); !(std::abs(det) > 0.0) || !std::isfinite(det))
    throw fileError(named.path, fmt::format("its grid '{}' has voxels of zero volume", gridName_),
                    "repair its transform");
  impl_->indexFromWorld = glm::inverse(impl_->worldFromIndex);
  impl_->centerW = placement.centerW.value_or(fileFromIndex(impl_->centerI)) - placement.originW;
  place_ = {.centerW = glm::vec3(impl_->centerW),
            .centerI = glm::vec3(impl_->centerI),
            .indexFromWorld = glm::mat3(impl_->indexFromWorld),
            .lowerI = glm::vec3(impl_->lowerI),
            .upperI = glm::vec3(impl_->upperI)};

  impl_->handle = nanovdb::openToNanoVDB(*grid);
  impl_->grid = impl_->handle.grid<float>();
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

DensityBuffers::DensityBuffers(const gpu::Device& device, const DensityGrid& grid)
    : words(device, {.name = "density", .size = checkedBytes(device, grid).size()}),
      place(gpu::createBufferWith(device, "density place", std::vector<glsl::DensityPlace>{grid.place()},
                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)),
      boundsW(grid.boundsW()),
      voxelMetres(grid.voxelMetres()) {
  gpu::upload(device, words, grid.nanoVdb());
}

glsl::LightReach lightReach(const Bounds& boundsW, double voxelMetres, const glm::dvec3& lightW) {
  const glm::dvec3 lower(boundsW.lower), upper(boundsW.upper), center = 0.5 * (lower + upper);
  const double nearest = glm::length(glm::max(glm::max(lower - lightW, lightW - upper), glm::dvec3(0.0)));
  const double farthest = glm::length(glm::max(glm::abs(lower - lightW), glm::abs(upper - lightW)));
  const double toCenter = glm::length(center - lightW);
  const glm::dvec3 axis = toCenter > 0.0 ? (center - lightW) / toCenter : glm::dvec3(0, 0, 1);
  double least = nearest > 0.0 ? 1.0 : -1.0;  // cosine of the cone that holds the bounds
  for (int corner = 0; corner < 8 && nearest > 0.0; ++corner) {
    const glm::dvec3 at((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                        (corner & 4) != 0 ? upper.z : lower.z);
    least = std::min(least, glm::dot(glm::normalize(at - lightW), axis));
  }
  // Half a texel more, so that what is looked up lies between texels.
  constexpr double kMargin = 1.0 + 1.0 / (glsl::kLightDepthSide - 1);
  const bool cone = least > 0.0;
  const double cell = (farthest - nearest) / (glsl::kLightDepthRadii - 1);
  return {.axisW = glm::vec3(axis),
          .halfWidth = static_cast<float>(kMargin * (cone ? std::sqrt(1.0 - least * least) / (1.0 + least) : 1.0)),
          .layers = cone ? 1 : 2,
          .near_ = static_cast<float>(nearest),
          .far_ = static_cast<float>(farthest),
          .substeps = static_cast<int>(std::clamp(std::ceil(cell / voxelMetres), 1.0, 4.0))};
}

}  // namespace gnomon
