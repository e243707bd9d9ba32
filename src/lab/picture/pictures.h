#pragma once
// Pictures for viewing: labels with a legend, visibility in grey, stored depth. Colours are from the palette of Okabe
// and Ito, "Color Universal Design" (2008), and differ in lightness too.

#include "base/image.h"
#include "truth/labels.h"

#include <span>
#include <string>
#include <vector>

namespace gnomon {

// `truth` darkens what agrees and is in shadow, so that shapes stay readable. A strip below the picture names
// every colour and counts its pixels. Leak and edge_light whose occluder no texel names have a colour of their own.
Image8 labelPicture(const Receivers& receivers, const Truth& truth, const LabelImage& labels, const std::string& title);

// What a label is drawn in, and a pixel whose occluder no texel names.
glm::u8vec3 labelColor(Label label);
inline constexpr glm::u8vec3 kUnseenColor(0, 158, 115);  // bluish green

// One value a pixel: 1 white, 0 black; kUnknownVisibility magenta; pixels without a surface dark blue.
Image8 visibilityPicture(const Receivers& receivers, std::span<const float> visibility);

// Where visibility differs from the truth: blue where it is lighter, vermillion where it is darker, stronger
// the more; grey shades of the truth elsewhere.
Image8 differencePicture(const Receivers& receivers, std::span<const float> visibility, std::span<const float> truth);

// The truth in the same shades.
std::vector<float> truthVisibility(const Receivers& receivers, const Truth& truth);

// Depth in metres, near bright and far dark; texels without a surface (infinity) dark blue.
Image8 depthPicture(const ImageF& metres);

// Numbers of instances and of their triangles (two channels, from 1; 0 none, dark blue): a hue for an instance, a shade
// for a triangle.
Image8 idPicture(const ImageF& ids);

// Texels per square metre (judge/texel_density.h), on a logarithmic ramp from dark blue to yellow, readable without red
// and green; not scored dark grey, uncovered reddish purple. A strip below has the scale and the median.
Image8 densityPicture(const Receivers& receivers, std::span<const float> densities, const std::string& title);

// Text in a built-in vector font of 7 pixels' height times `scale`; (x, y) is its upper left corner.
int textWidth(int scale, const std::string& text);  // pixels
void drawText(Image8& image, int x, int y, int scale, const std::string& text, const glm::u8vec3& color);

}  // namespace gnomon
