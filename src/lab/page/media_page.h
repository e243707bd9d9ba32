#pragma once
// The page of a medium: its table, error against time, the shafts' edges, every picture.

#include "lab/results/media_results.h"

#include <filesystem>

namespace gnomon {

// `media` has a row.
std::string mediaHtml(const std::filesystem::path& folder, const MediaResults& media);

}  // namespace gnomon
