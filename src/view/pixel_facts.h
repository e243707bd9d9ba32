#pragma once
// Why a pixel is as it is, in words and numbers: the surface, the exact shadow, which texel decided, what it holds and
// what stands there, and the reason of the label.

#include "view/picture_worker.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// What a texel is called: of which slice of a side's map.
struct TexelPlace {
  int slice = 0;
  glm::ivec2 texel{0};
};
// The texel that decided a pixel; none where the picture is not refined with a loupe, or no texel was asked.
std::optional<TexelPlace> texelOf(const ViewPicture& picture, int side, glm::ivec2 pixel);
// Where it stands in SidePicture::unfolded, pixels.
glm::ivec2 placeInUnfolded(const FittedMap& fitted, const TexelPlace& place);
std::optional<TexelPlace> texelAtUnfolded(const FittedMap& fitted, glm::ivec2 place);

// One fact a line.
std::vector<std::string> pixelFacts(const ViewPicture& picture, int side, glm::ivec2 pixel);

// "acne 120 (0.14%), leak 3, edges 80 of 82,797 scored".
std::string countsLine(const ViewCounts& counts);

}  // namespace gnomon
