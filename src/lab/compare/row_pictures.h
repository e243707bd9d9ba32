#pragma once
// Writes the pictures of a comparison into its folder.

#include "lab/compare/compare.h"

namespace gnomon {

// Of the numbers in an EXR's channel "label" (truth/labels.h).
inline constexpr const char* kLabelUnits =
    "0 not scored, 1 agree, 2 acne, 3 leak, 4 edge_shadow, 5 edge_light, 6 uncovered";

// The truth through one filter.
struct FilteredTruth {
  std::vector<float> visibility;  // one a pixel
  Image8 beauty;
};

// Depth, second depth and gap where the map has two layers, and the truth.
Pictures writeMapPictures(const gpu::Device& device, const Receivers& receivers, const Occluders& occluders,
                          const FilteredTruth& truth, const std::filesystem::path& outDir, const std::string& mapName);

Pictures writeFilteredTruth(const Receivers& receivers, const FilteredTruth& truth, const std::filesystem::path& outDir,
                            const std::string& stem);

struct RowPictureNames {
  std::string stem;       // map/bias[.tuned][.filter]
  std::string labelStem;  // map/bias[.tuned]: all filters share the labels, and the first one writes them
  std::string title;
  bool writesLabels = true;
};
Pictures writeRowPictures(const GroundTruth& exact, const LabelledResult& judged, std::span<const float> visibility,
                          const Image8& beauty, const FilteredTruth& truth, const RowPictureNames& names,
                          const std::filesystem::path& outDir);

// The kWorstSide square with the most pixels of this label; none where there is not one.
std::optional<WorstPlace> findWorstPlace(const LabelImage& labels, int width, int height, Label label);

}  // namespace gnomon
