#pragma once
// Pictures of a medium: exposed PNGs for people, EXRs for data, differences, the place where methods err
// most.

#include "lab/fog_measure.h"

#include <filesystem>

namespace gnomon {

// R, G, B of surfaces and medium together and medium.R, medium.G, medium.B of the medium alone; cd/m^2.
void writeFogExr(const std::filesystem::path& path, const FogView& view, const ImageF& inScattered);

// measured - reference in the medium's brightness: blue where it is lighter, vermillion where it is darker,
// full at kFullDifference of the exposed picture's white; the picture in grey elsewhere.
inline constexpr float kFullDifference = 0.05f;
Image8 mediaDifferencePicture(const FogView& view, const ImageF& measured, const ImageF& reference,
                              const FogExposure& exposure);

// Cuts a square out, each pixel magnified `zoom` times.
Image8 cropped(const Image8& image, const WorstPlace& place, int zoom);

// Beauty, difference and crops below `outDir` under the method's name; the last two where there is a
// reference.
Pictures writeMediaRowPictures(const FogView& view, const ImageF& inScattered, const ImageF* reference,
                               const std::optional<WorstPlace>& worst, const FogExposure& exposure,
                               const std::string& stem, const std::filesystem::path& outDir);

}  // namespace gnomon
