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
    // A random number, so that no two files are equal; nothing reads it. Behind the magic number, the version of the
    // format and of the library, and a flag.
    constexpr std::streamoff kUuidAt = 8 + 4 + 2 * 4 + 1;
    out.seekp(kUuidAt);
    out << "00000000-0000-4000-8000-000000000000";
    out.seekp(0, std::ios::end);
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
