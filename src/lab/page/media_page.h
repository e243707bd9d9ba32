#pragma once
// The report of gnomon fog: the table, error against time, crops of the shafts' edges, every picture.

#include "lab/results/media_results.h"

#include <filesystem>

namespace gnomon {

// `media` has a row.
std::string mediaHtml(const std::filesystem::path& folder, const MediaResults& media);

}  // namespace gnomon
