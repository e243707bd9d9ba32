#include "vsv/media/density_file.h"

#include "base/child.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "vsv/vdb_archive.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <tbb/task_arena.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// What reading may take. A voxel takes 4 bytes in OpenVDB and 4 in NanoVDB, while both are there; in the file, well
// packed smoke takes a twentieth. The constant is for what is small.
constexpr uint64_t kBytesAlways = 512 << 20, kBytesPerByte = 256;
constexpr int kSecondsAlways = 20;
constexpr uint64_t kBytesPerSecond = 4 << 20;

struct Named {
  std::string path, grid;  // no grid: the only one
};

// A colon ends the path only behind ".vdb".
Named splitName(const std::string& fileAndGrid) {
  const size_t colon = fileAndGrid.rfind(".vdb:");
  if (colon == std::string::npos) return {fileAndGrid, ""};
  return {fileAndGrid.substr(0, colon + 4), fileAndGrid.substr(colon + 5)};
}

// Reads as openvdb::io::File does, but from memory, where everything that would lie beyond the end throws: OpenVDB
// itself goes on with what a failed read leaves.
class BoundedArchive final : public openvdb::io::Archive {
 public:
  explicit BoundedArchive(std::string bytes) : in_(std::move(bytes)) {
    in_.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    openvdb::io::setStreamMetadataPtr(in_, metadata_, /*transfer=*/false);
    readHeader(in_);
    setFormatVersion(in_);
    setLibraryVersion(in_);
    setDataCompression(in_);
    openvdb::MetaMap().readMeta(in_);
    for (int32_t left = readGridCount(in_); left > 0; --left) readEntry();
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Entry& entry : entries_) names.push_back(printable(nameOf(entry.about)));
    return names;
  }
  bool has(const std::string& name) const { return find(name) != nullptr; }

  openvdb::GridBase::Ptr read(const std::string& name) {
    const Entry& entry = *find(name);
    const openvdb::GridBase::Ptr grid = readOf(entry);
    if (!entry.about.isInstance()) return grid;
    const openvdb::Name& parentName = entry.about.instanceParentName();
    const Entry* parent = find(openvdb::io::GridDescriptor::nameAsString(parentName));
    if (parent == nullptr || parent->about.isInstance()) throw openvdb::IoError("its tree is not in the file");
    connectInstance(entry.about, {{entry.about.uniqueName(), grid}, {parentName, readOf(*parent)}});
    return grid;
  }

 private:
  struct Entry {
    openvdb::io::GridDescriptor about;
    openvdb::GridBase::Ptr grid;  // empty, where the file says where the rest of it is
  };

  static std::string nameOf(const openvdb::io::GridDescriptor& about) {
    return openvdb::io::GridDescriptor::nameAsString(about.uniqueName());
  }

  void readEntry() {
    Entry entry;
    entry.grid = entry.about.read(in_);
    if (inputHasGridOffsets())
      entry.about.seekToEnd(in_);
    else
      readGrid(entry.grid, entry.about, in_);
    entries_.push_back(std::move(entry));
  }

  const Entry* find(const std::string& name) const {
    for (const Entry& entry : entries_)
      if (nameOf(entry.about) == name || entry.about.gridName() == name) return &entry;
    return nullptr;
  }

  openvdb::GridBase::Ptr readOf(const Entry& entry) {
    if (inputHasGridOffsets()) {
      entry.about.seekToGrid(in_);
      readGrid(entry.grid, entry.about, in_);
    }
    return entry.grid;
  }

  openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};  // the stream has its address
  std::istringstream in_;
  std::vector<Entry> entries_;
};

openvdb::GridBase::Ptr readNamed(BoundedArchive& archive, const Named& named) {
  const std::string all = fmt::format("{}", fmt::join(archive.names(), ", "));
  if (archive.names().empty()) throw fileError(named.path, "it has no grid", "use another file");
  if (named.grid.empty() && archive.names().size() > 1)
    throw fileError(named.path, "it has several grids",
                    fmt::format("name one, as in {}:{}; it has {}", named.path, archive.names().front(), all));
  const std::string name = named.grid.empty() ? archive.names().front() : named.grid;
  if (!archive.has(name))
    throw fileError(named.path, fmt::format("it has no grid '{}'", name), fmt::format("choose from {}", all));
  return archive.read(name);
}

openvdb::FloatGrid::Ptr checkedGrid(const openvdb::GridBase::Ptr& base, const Named& named) {
  const auto complain = [&](const std::string& what, const char* remedy) {
    return fileError(named.path, fmt::format("its grid '{}' {}", printable(base->getName()), what), remedy);
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

DensityFile::Facts factsOf(const openvdb::FloatGrid& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const openvdb::math::Transform& transform = grid.transform();
  const openvdb::Vec3d center = 0.5 * (box.min().asVec3d() + box.max().asVec3d());
  const glm::dvec3 origin = toGlm(transform.indexToWorld(openvdb::Vec3d(0.0)));
  DensityFile::Facts facts{.lowerI = toGlm(box.min().asVec3d()),
                           .upperI = toGlm(box.max().asVec3d()),
                           .centerW = toGlm(transform.indexToWorld(center)),
                           .activeVoxels = grid.activeVoxelCount()};
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d unit(0.0);
    unit[axis] = 1.0;
    facts.worldFromIndex[axis] = toGlm(transform.indexToWorld(unit)) - origin;
  }
  return facts;
}

// The facts, the name's length, the name, the grid.
std::string packed(const Named& named, std::string bytes) {
  try {
    openvdb::initialize();
    BoundedArchive archive(std::move(bytes));
    const openvdb::FloatGrid::Ptr grid = checkedGrid(readNamed(archive, named), named);
    const DensityFile::Facts facts = factsOf(*grid);
    const nanovdb::GridHandle<nanovdb::HostBuffer> nano = nanovdb::openToNanoVDB(*grid);
    const std::string name = grid->getName();
    const uint64_t length = name.size();
    std::string all(reinterpret_cast<const char*>(&facts), sizeof(facts));
    all.append(reinterpret_cast<const char*>(&length), sizeof(length));
    all += name;
    return all.append(reinterpret_cast<const char*>(nano.data()), nano.size());
  } catch (const WorldError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::ios_base::failure&) {
    throw fileError(named.path, "it cannot be read as OpenVDB (it ends too soon)", "use a complete .vdb file");
  } catch (const std::exception& error) {  // OpenVDB's own, and what a broken file makes the library throw
    throw fileError(named.path, fmt::format("it cannot be read as OpenVDB ({})", oneLine(openVdbMessage(error), 120)),
                    "use a complete .vdb file");
  }
}

DensityFile unpacked(const Named& named, const std::string& bytes) {
  DensityFile file{.path = named.path, .gridName = {}, .facts = {}, .nanoVdb = {}};
  uint64_t length = 0;
  constexpr size_t kHead = sizeof(file.facts) + sizeof(length);
  if (bytes.size() >= kHead) {
    std::memcpy(&file.facts, bytes.data(), sizeof(file.facts));
    std::memcpy(&length, bytes.data() + sizeof(file.facts), sizeof(length));
  }
  // A file may have made of its reader what it liked.
  if (bytes.size() < kHead || length > bytes.size() - kHead)
    throw fileError(named.path, "is damaged: it crashes its reader", "use another file");
  file.gridName = printable(bytes.substr(kHead, length));
  file.nanoVdb = bytes.substr(kHead + length);
  return file;
}

}  // namespace

DensityFile readDensityFile(const std::string& fileAndGrid) {
  const Named named = splitName(fileAndGrid);
  std::error_code failure;
  if (!fs::exists(named.path, failure)) throw fileError(named.path, "there is no such file", "check the name");
  if (!fs::is_regular_file(named.path, failure)) throw fileError(named.path, "is no regular file", "name one");
  const Descriptor input(::open(named.path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status = {};
  if (!input.isOpen() || ::fstat(input.get(), &status) != 0)
    throw fileError(named.path, "cannot be read", std::strerror(errno));
  const auto size = static_cast<uint64_t>(status.st_size);
  const ChildLimits limits{.bytes = kBytesAlways + kBytesPerByte * size,
                           .seconds = kSecondsAlways + static_cast<int>(size / kBytesPerSecond)};
  const ChildWork work{.file = named.path,
                       .name = kDensityWork,
                       .arguments = {named.path, named.grid},
                       .inputFile = input.get(),
                       .program = "gnomon-reader"};
  return unpacked(named, runInChild(work, limits));
}

std::string packedDensity(const std::vector<std::string>& pathAndGrid, std::string bytes) {
  // Alone, because no thread can be started there.
  tbb::task_arena alone(1);
  return alone.execute([&] { return packed({pathAndGrid.at(0), pathAndGrid.at(1)}, std::move(bytes)); });
}

DensityFile readDensityBytes(const std::string& fileAndGrid, std::string bytes) {
  const Named named = splitName(fileAndGrid);
  return unpacked(named, packed(named, std::move(bytes)));
}

}  // namespace gnomon
