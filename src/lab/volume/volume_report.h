#pragma once
// The results of `gnomon vsv`, as a table for the terminal and as JSON (docs/volume_check.md describes both).

#include "lab/volume/volume_validation.h"

#include <string>

namespace gnomon {

inline constexpr int kVolumeReportVersion = 1;

std::string volumeTable(const Session& session, const VolumeOptions& options, const VolumeResult& result);

std::string volumeJson(const Session& session, const VolumeOptions& options, const VolumeResult& result);

}  // namespace gnomon
