#pragma once
// Pictures of a medium: exposed PNGs for viewing, EXRs for data, differences, and a crop where the error is largest.

#include "lab/fog/fog_measure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// R, G, B of surfaces and medium together and medium.R, medium.G, medium.B of the medium alone; cd/m^2.
void writeFogExr(const std::filesystem::path& path, const FogView& view, const ImageF& inScattered);

// What one picture can show, by name: beauty (surfaces and medium), medium (alone, at its own exposure).
std::vector<std::string> fogPicturesToShow();

struct FogExposures {
  FogExposure composed;  // of surfaces and medium together
  FogExposure medium;    // of the medium alone
};

// measured - reference of the medium alone: blue where it is lighter, vermillion where it is darker, in full
// where they are kFullDifference of the exposed medium's white apart; the medium in grey elsewhere.
inline constexpr float kFullDifference = 0.1f;
Image8 mediaDifferencePicture(const ImageF& measured, const ImageF& reference, const FogExposure& exposure);

// A square cut out, each pixel magnified `zoom` times.
Image8 cropped(const Image8& image, const WorstPlace& place, int zoom);

// Below `outDir`, from `stem` on: beauty (surfaces and medium), medium, data; and where there is a reference
// the difference, and the worst place of the medium, the reference's and the difference side by side.
Pictures writeMediaRowPictures(const FogView& view, const ImageF& inScattered, const ImageF* reference,
                               const std::optional<WorstPlace>& worst, const FogExposures& exposures,
                               const std::string& stem, const std::filesystem::path& outDir);

}  // namespace gnomon
