#pragma once
// What volume_grid.cpp and vdb_file.cpp share: the one header here that brings OpenVDB's in.

#include "vsv/check/volume_grid.h"

#include <openvdb/openvdb.h>

namespace gnomon {

struct VolumeGrid::Impl {
  openvdb::MaskGrid::Ptr grid;
  glsl::EpipolarGrid epipolar;
};

// openvdb::initialize(), before anything else of it.
void startOpenVdb();

}  // namespace gnomon
