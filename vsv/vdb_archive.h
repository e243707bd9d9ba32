#pragma once
// Writes .vdb files, and passes on OpenVDB's error messages. For the .cpp files that include OpenVDB anyway.

#include "base/error.h"
#include "base/file.h"

#include <openvdb/openvdb.h>

#include <filesystem>
#include <ostream>
#include <string>

namespace gnomon {

// OpenVDB puts the exception's name before the text.
inline std::string openVdbMessage(const std::exception& error) {
  const std::string text = error.what();
  const size_t colon = text.find(": ");
  return colon == std::string::npos ? text : text.substr(colon + 2);
}

// OpenVDB's own File writes to a stream whose failures it does not look at, so that a full disk would go unseen.
class CheckedArchive : public openvdb::io::Archive {
 public:
  void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& meta) const {
    Archive::write(out, grids, /*seekable=*/true, meta);
  }
};

// Whole or not at all. Throws WorldError.
inline void writeGrids(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                       const openvdb::MetaMap& meta) {
  try {
    writeFile(path, [&](std::ostream& out) { CheckedArchive().writeTo(out, grids, meta); });
  } catch (const openvdb::Exception& error) {
    throw fileError(path.string(), "cannot be written", openVdbMessage(error));
  }
}

}  // namespace gnomon
