#pragma once
// The page of a medium: its table, error against time, the shafts' edges, every picture.

#include "lab/page/media_data.h"

#include <filesystem>

namespace gnomon {

// `data.media` is there.
std::string mediaHtml(const std::filesystem::path& folder, const ReportData& data);

}  // namespace gnomon
