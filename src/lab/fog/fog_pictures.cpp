#include "lab/fog/fog_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {

namespace {

constexpr int kCropZoom = 5;

// Okabe and Ito's blue and vermillion, as in the comparison's difference pictures.
constexpr std::array kLighter = {0.0f, 0.447f, 0.698f};
constexpr std::array kDarker = {0.835f, 0.369f, 0.0f};

float brightness(const float* rgb) {
  return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];  // IEC 61966-2-1's primaries
}

Image8 beside(const std::vector<Image8>& images) {
  Image8 all(0, images.front().height, 3);
  constexpr int kGap = 8;
  for (const Image8& image : images) all.width += image.width + (all.width > 0 ? kGap : 0);
  all.values.assign(static_cast<size_t>(all.width) * static_cast<size_t>(all.height) * 3, 255);
  int left = 0;
  for (const Image8& image : images) {
    for (int y = 0; y < image.height; ++y) std::copy_n(image.at(0, y), 3 * image.width, all.at(left, y));
    left += image.width + kGap;
  }
  return all;
}

}  // namespace

void writeFogExr(const std::filesystem::path& path, const FogView& view, const ImageF& inScattered) {
  const ImageF radiance = composed(view, inScattered);
  ImageF all(radiance.width, radiance.height, 6);
  for (size_t i = 0; i < radiance.values.size() / 3; ++i) {
    std::copy_n(&radiance.values[3 * i], 3, &all.values[6 * i]);
    std::copy_n(&inScattered.values[3 * i], 3, &all.values[6 * i + 3]);
  }
  writeExr(path, all,
           {.names = {"R", "G", "B", "medium.R", "medium.G", "medium.B"}, .units = "cd/m^2", .isColour = true});
}

Image8 mediaDifferencePicture(const ImageF& measured, const ImageF& reference, const FogExposure& exposure) {
  const Image8 picture = exposed(reference, exposure);
  Image8 shown(reference.width, reference.height, 3);
  for (size_t i = 0; i < shown.values.size() / 3; ++i) {
    const float difference =
        exposure.factor * (brightness(&measured.values[3 * i]) - brightness(&reference.values[3 * i]));
    const float share = std::min(std::abs(difference) / kFullDifference, 1.0f);
    const auto& color = difference > 0.0f ? kLighter : kDarker;
    const float grey = 0.35f + 0.5f * static_cast<float>(picture.values[3 * i + 1]) / 255.0f;
    for (size_t c = 0; c < 3; ++c)
      shown.values[3 * i + c] = static_cast<uint8_t>(std::lround(255.0f * (grey + (color[c] - grey) * share)));
  }
  return shown;
}

std::vector<std::string> fogPicturesToShow() {
  return {"beauty", "medium"};
}

Image8 cropped(const Image8& image, const WorstPlace& place, int zoom) {
  Image8 crop(place.size * zoom, place.size * zoom, 3);
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x)
      std::copy_n(image.at(place.x + x / zoom, place.y + y / zoom), 3, crop.at(x, y));
  return crop;
}

Pictures writeMediaRowPictures(const FogView& view, const ImageF& inScattered, const ImageF* reference,
                               const std::optional<WorstPlace>& worst, const FogExposures& exposures,
                               const std::string& stem, const std::filesystem::path& outDir) {
  Pictures pictures;
  const auto write = [&](const char* kind, const Image8& image) {
    const std::string path = stem + "." + kind + ".png";
    writePng(outDir / path, image);
    pictures.emplace_back(kind, path);
  };
  write("beauty", exposed(composed(view, inScattered), exposures.composed));
  const Image8 medium = exposed(inScattered, exposures.medium);
  write("medium", medium);
  if (reference != nullptr) {
    const Image8 difference = mediaDifferencePicture(inScattered, *reference, exposures.medium);
    write("difference", difference);
    if (worst)
      write("crop", beside({cropped(medium, *worst, kCropZoom),
                            cropped(exposed(*reference, exposures.medium), *worst, kCropZoom),
                            cropped(difference, *worst, kCropZoom)}));
  }
  writeFogExr(outDir / (stem + ".exr"), view, inScattered);
  pictures.emplace_back("data", stem + ".exr");
  return pictures;
}

}  // namespace gnomon
