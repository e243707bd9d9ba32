#include "lab/compare/row_pictures.h"

#include "lab/core/depth_images.h"
#include "lab/picture/pictures.h"
#include "lab/picture/unfold.h"

#include <algorithm>

namespace gnomon {

namespace {

// EXR for data: the visibility predicted and true, and the label's number (Label in truth/labels.h).
ImageF dataImage(const GroundTruth& exact, const LabelledResult& judged, std::span<const float> visibility,
                 std::span<const float> truth) {
  ImageF image(exact.receivers.width, exact.receivers.height, 3);
  for (size_t i = 0; i < truth.size(); ++i) {
    image.values[3 * i] = visibility[i];
    image.values[3 * i + 1] = truth[i];
    image.values[3 * i + 2] = static_cast<float>(judged.labels.labels[i]);
  }
  return image;
}

}  // namespace

Pictures writeMapPictures(const gpu::Device& device, const Receivers& receivers, const Occluders& occluders,
                          const FilteredTruth& truth, const std::filesystem::path& outDir, const std::string& mapName) {
  const glsl::ShadowMap& map = occluders.fitted().map;
  Pictures pictures;
  const auto writeDepth = [&](const char* name, const ImageF& metres) {
    const std::string stem = mapName + "/" + name;
    writePng(outDir / (stem + ".png"), depthPicture(metres));
    writeExr(outDir / (stem + ".exr"), metres, {.names = {"metres"}, .units = "metres"});
    pictures.emplace_back(name, stem + ".png");
  };
  const DepthImages depth = depthInMetres(device, occluders);
  writeDepth("depth", depth.first);
  if (map.sliceCount > 1) {
    const std::string path = mapName + "/unfolded.png";
    writePng(outDir / path, unfoldedPicture(depthPicture(depth.first), occluders.fitted(), {64, 48, 64}));
    pictures.emplace_back("unfolded", path);
  }
  if (depth.second) writeDepth("second_depth", *depth.second);
  if (depth.gap) writeDepth("layer_gap", *depth.gap);
  const Pictures truths = writeFilteredTruth(receivers, truth, outDir, mapName + "/truth");
  pictures.emplace_back("truth", truths[0].second);
  pictures.emplace_back("truth_beauty", truths[1].second);
  return pictures;
}

Pictures writeFilteredTruth(const Receivers& receivers, const FilteredTruth& truth, const std::filesystem::path& outDir,
                            const std::string& stem) {
  writePng(outDir / (stem + ".png"), visibilityPicture(receivers, truth.visibility));
  writePng(outDir / (stem + ".beauty.png"), truth.beauty);
  return {{"visibility", stem + ".png"}, {"beauty", stem + ".beauty.png"}};
}

Pictures writeRowPictures(const GroundTruth& exact, const LabelledResult& judged, std::span<const float> visibility,
                          const Image8& beauty, const FilteredTruth& truth, const RowPictureNames& names,
                          const std::filesystem::path& outDir) {
  const std::string& stem = names.stem;
  const std::string labels = names.labelStem + ".labels.png";
  if (names.writesLabels)
    writePng(outDir / labels, labelPicture(exact.receivers, exact.truth, judged.labels, names.title));
  writePng(outDir / (stem + ".visibility.png"), visibilityPicture(exact.receivers, visibility));
  writePng(outDir / (stem + ".beauty.png"), beauty);
  writePng(outDir / (stem + ".difference.png"), differencePicture(exact.receivers, visibility, truth.visibility));
  writeExr(
      outDir / (stem + ".exr"), dataImage(exact, judged, visibility, truth.visibility),
      {.names = {"visibility", "truth", "label"},
       .units = std::string("visibility and truth: share of the light that arrives, 0 to 1; label: ") + kLabelUnits});
  return {{"labels", labels},
          {"visibility", stem + ".visibility.png"},
          {"beauty", stem + ".beauty.png"},
          {"difference", stem + ".difference.png"},
          {"data", stem + ".exr"}};
}

std::optional<WorstPlace> findWorstPlace(const LabelImage& labels, int width, int height, Label label) {
  // Summed areas (Crow 1984), one row and column more than the picture.
  const auto stride = static_cast<size_t>(width) + 1;
  std::vector<uint32_t> sums(stride * (static_cast<size_t>(height) + 1), 0);
  for (size_t y = 0; y < static_cast<size_t>(height); ++y)
    for (size_t x = 0; x + 1 < stride; ++x)
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + sums[(y + 1) * stride + x] - sums[y * stride + x] +
                                       (labels.labels[y * (stride - 1) + x] == label ? 1 : 0);
  const int size = std::min({kWorstSide, width, height});
  WorstPlace worst{.size = size, .pixels = 0};
  for (int y = 0; y + size <= height; ++y) {
    for (int x = 0; x + size <= width; ++x) {
      const auto at = [&](int column, int row) { return sums[static_cast<size_t>(row) * stride + column]; };
      const size_t pixels = at(x + size, y + size) - at(x, y + size) - at(x + size, y) + at(x, y);
      if (pixels > worst.pixels) worst = {.x = x, .y = y, .size = size, .pixels = pixels};
    }
  }
  if (worst.pixels == 0) return std::nullopt;
  return worst;
}

}  // namespace gnomon
