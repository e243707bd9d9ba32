#pragma once
// Writes and reads results.json. docs/results.md describes it, and a test checks the two against each other.

#include "lab/results/comparison.h"
#include "lab/results/media_results.h"

#include <filesystem>
#include <variant>

namespace gnomon {

// Of a results.json that is read; one of a hundred rows has half a megabyte.
inline constexpr uint64_t kMostResultsBytes = 64 << 20;

// The whole file as text.
std::string resultsText(const Comparison& comparison);
std::string resultsText(const MediaResults& media);

using Results = std::variant<Comparison, MediaResults>;

// Reads folder/results.json: schema 4; of those before, which had fewer fields, what there is. Throws WorldError that
// names the file, and the field where one is wrong.
Results readResults(const std::filesystem::path& folder);

}  // namespace gnomon
