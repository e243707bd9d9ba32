#include "lab/picture/pictures.h"

#include "judge/texel_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_easy_font.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr glm::u8vec3 kNothing(16, 20, 38);  // no surface
constexpr glm::u8vec3 kDark(44, 46, 52);     // faces away or outside the cone
constexpr glm::u8vec3 kAgreeLit(222, 222, 222);
constexpr glm::u8vec3 kAgreeShadow(112, 112, 112);
constexpr glm::u8vec3 kText(235, 235, 235);

}  // namespace

glm::u8vec3 labelColor(Label label) {
  switch (label) {
    case Label::NotScored:
      return kDark;
    case Label::Agree:
      return kAgreeLit;
    case Label::Acne:
      return {213, 94, 0};  // vermillion
    case Label::Leak:
      return {0, 114, 178};  // blue
    case Label::EdgeShadow:
      return {240, 228, 66};  // yellow
    case Label::EdgeLight:
      return {86, 180, 233};  // sky blue
    case Label::Uncovered:
      return {204, 121, 167};  // reddish purple
  }
  return {255, 0, 255};
}

namespace {

void setPixel(Image8& image, int x, int y, const glm::u8vec3& color) {
  uint8_t* p = image.at(x, y);
  for (int c = 0; c < 3; ++c) p[c] = color[c];
}

void fillRectangle(Image8& image, int x0, int y0, int x1, int y1, const glm::u8vec3& color) {
  for (int y = std::max(y0, 0); y < std::min(y1, image.height); ++y)
    for (int x = std::max(x0, 0); x < std::min(x1, image.width); ++x) setPixel(image, x, y, color);
}

struct LegendEntry {
  std::string text;
  glm::u8vec3 color;
};

std::vector<LegendEntry> legendEntries(const LabelImage& labels, const Receivers& receivers) {
  std::vector<LegendEntry> entries = {{fmt::format("agree {} (lit, shadow)", labels.count(Label::Agree)), kAgreeLit}};
  for (const Label label : {Label::Acne, Label::Leak, Label::EdgeShadow, Label::EdgeLight, Label::Uncovered})
    entries.push_back({fmt::format("{} {}", labelName(label), labels.count(label)), labelColor(label)});
  if (labels.unseen)
    entries.push_back({fmt::format("of leak and edge_light unseen {}", labels.unseen->occluders), kUnseenColor});
  entries.push_back({fmt::format("not scored {}", receivers.facingAway + receivers.outsideCone), kDark});
  return entries;
}

// Lays the legend out in rows; with a canvas it also draws it. Returns the height it takes, pixels.
int layOutLegend(Image8* canvas, int width, int top, int scale, const std::string& title,
                 const std::vector<LegendEntry>& entries) {
  const int line = 12 * scale;
  const int swatch = 8 * scale;
  int x = 4 * scale;
  int y = top + 4 * scale;
  if (canvas != nullptr) drawText(*canvas, x, y, scale, title, kText);
  y += line;
  for (const LegendEntry& entry : entries) {
    const int needed = swatch + 3 * scale + textWidth(scale, entry.text) + 8 * scale;
    if (x + needed > width && x > 4 * scale) {
      x = 4 * scale;
      y += line;
    }
    if (canvas != nullptr) {
      fillRectangle(*canvas, x, y - scale, x + swatch, y - scale + swatch, entry.color);
      if (entry.color == kAgreeLit)
        fillRectangle(*canvas, x + swatch / 2, y - scale, x + swatch, y - scale + swatch, kAgreeShadow);
      drawText(*canvas, x + swatch + 3 * scale, y, scale, entry.text, kText);
    }
    x += needed;
  }
  return y + line - top;
}

// Nunez, Anderton, Renslow, "Optimizing colormaps with consideration for color vision deficiency" (2018):
// cividis at equal steps; its lightness rises evenly.
glm::u8vec3 rampColor(double t) {
  static constexpr std::array<glm::u8vec3, 9> kRamp = {
      glm::u8vec3(0, 32, 76),     glm::u8vec3(0, 48, 111),    glm::u8vec3(57, 72, 108),
      glm::u8vec3(87, 93, 109),   glm::u8vec3(112, 113, 115), glm::u8vec3(138, 134, 120),
      glm::u8vec3(166, 157, 117), glm::u8vec3(208, 190, 100), glm::u8vec3(255, 233, 69)};
  const double at = std::clamp(t, 0.0, 1.0) * (kRamp.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), kRamp.size() - 2);
  return glm::u8vec3(glm::mix(glm::dvec3(kRamp[i]), glm::dvec3(kRamp[i + 1]), at - static_cast<double>(i)) + 0.5);
}

// Whole decades that hold the positive densities, but for the hundredth at either end: texels all but edge-on
// to the light are not worth the ramp's range.
struct Decades {
  int lower = 0;
  int upper = 1;
};

Decades decadesOf(std::span<const float> densities) {
  std::vector<float> positive;
  std::ranges::copy_if(densities, std::back_inserter(positive), [](float d) { return d > 0.0f; });
  if (positive.empty()) return {};
  std::ranges::sort(positive);
  const size_t hundredth = positive.size() / 100;
  const int lower = static_cast<int>(std::floor(std::log10(positive[hundredth])));
  const int upper = static_cast<int>(std::ceil(std::log10(positive[positive.size() - 1 - hundredth])));
  return {.lower = lower, .upper = std::max(upper, lower + 1)};
}

void drawRamp(Image8& image, int top, int scale, const Decades& decades) {
  const int left = 4 * scale;
  const int right = image.width - 40 * scale;
  for (int x = left; x < right; ++x)
    fillRectangle(image, x, top, x + 1, top + 8 * scale, rampColor(static_cast<double>(x - left) / (right - left)));
  for (int decade = decades.lower; decade <= decades.upper; ++decade) {
    const int x = left + (right - left - 1) * (decade - decades.lower) / (decades.upper - decades.lower);
    fillRectangle(image, x, top, x + scale, top + 11 * scale, kText);
    drawText(image, x, top + 13 * scale, scale, fmt::format("1e{}", decade), kText);
  }
}

}  // namespace

Image8 idPicture(const ImageF& ids) {
  Image8 picture(ids.width, ids.height, 3);
  for (int y = 0; y < ids.height; ++y) {
    for (int x = 0; x < ids.width; ++x) {
      const auto instance = static_cast<uint32_t>(ids.at(x, y)[0]), triangle = static_cast<uint32_t>(ids.at(x, y)[1]);
      glm::u8vec3 color = kNothing;
      if (instance != 0) {
        // Hues by the golden ratio: neighbours in number are far apart in colour. Shades by a hash.
        const float turn = 6.2831853f * glm::fract(0.61803399f * static_cast<float>(instance));
        const float shade = 0.35f + 0.6f * static_cast<float>(triangle * 2654435761u >> 16) / 65536.0f;
        const glm::vec3 hue = 0.5f + 0.5f * glm::cos(turn + glm::vec3(0.0f, 2.0943951f, 4.1887902f));
        color = glm::u8vec3(255.0f * shade * glm::mix(glm::vec3(1.0f), hue, 0.75f));
      }
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = color[c];
    }
  }
  return picture;
}

Image8 densityPicture(const Receivers& receivers, std::span<const float> densities, const std::string& title) {
  const int scale = std::max(1, receivers.width / 500);
  const Decades decades = decadesOf(densities);
  Image8 image(receivers.width, receivers.height + 50 * scale, 3);
  for (int y = 0; y < receivers.height; ++y) {
    for (int x = 0; x < receivers.width; ++x) {
      const size_t i = static_cast<size_t>(y) * receivers.width + x;
      glm::u8vec3 color = receivers.states[i] == PixelState::Empty ? kNothing : kDark;
      if (receivers.states[i] == PixelState::Scored) {
        const double decade = std::log10(std::max(static_cast<double>(densities[i]), 1e-30));
        color = densities[i] < 0.0f ? labelColor(Label::Uncovered)
                                    : rampColor((decade - decades.lower) / (decades.upper - decades.lower));
      }
      setPixel(image, x, y, color);
    }
  }
  fillRectangle(image, 0, receivers.height, image.width, image.height, kNothing);
  drawText(image, 4 * scale, receivers.height + 4 * scale, scale, title, kText);
  drawText(image, 4 * scale, receivers.height + 14 * scale, scale,
           fmt::format("texels per square metre; median {:.4g}", medianDensity(densities)), kText);
  drawRamp(image, receivers.height + 26 * scale, scale, decades);
  return image;
}

int textWidth(int scale, const std::string& text) {
  return stb_easy_font_width(const_cast<char*>(text.c_str())) * scale;
}

void drawText(Image8& image, int x, int y, int scale, const std::string& text, const glm::u8vec3& color) {
  struct Vertex {
    float x, y, z;
    uint8_t rgba[4];
  };
  std::vector<Vertex> vertices(300 * text.size() / 16 * 4 + 1024);
  const int quads = stb_easy_font_print(0.0f, 0.0f, const_cast<char*>(text.c_str()), nullptr, vertices.data(),
                                        static_cast<int>(vertices.size() * sizeof(Vertex)));
  for (int q = 0; q < quads; ++q) {
    const Vertex& a = vertices[4 * q];
    const Vertex& c = vertices[4 * q + 2];
    fillRectangle(image, x + static_cast<int>(a.x) * scale, y + static_cast<int>(a.y) * scale,
                  x + static_cast<int>(c.x) * scale, y + static_cast<int>(c.y) * scale, color);
  }
}

Image8 labelPicture(const Receivers& receivers, const Truth& truth, const LabelImage& labels,
                    const std::string& title) {
  const int scale = std::max(1, receivers.width / 500);
  const std::vector<LegendEntry> entries = legendEntries(labels, receivers);
  const int legendHeight = layOutLegend(nullptr, receivers.width, 0, scale, title, entries);
  Image8 image(receivers.width, receivers.height + legendHeight, 3);
  for (int y = 0; y < receivers.height; ++y) {
    for (int x = 0; x < receivers.width; ++x) {
      const size_t i = static_cast<size_t>(y) * receivers.width + x;
      glm::u8vec3 color = labelColor(labels.labels[i]);
      if (receivers.states[i] == PixelState::Empty)
        color = kNothing;
      else if (labels.labels[i] == Label::Agree && truth.lit[i] == 0)
        color = kAgreeShadow;
      else if (labels.unseen && labels.unseen->of[i] != Unseen::Nothing)
        color = kUnseenColor;
      setPixel(image, x, y, color);
    }
  }
  fillRectangle(image, 0, receivers.height, image.width, image.height, kNothing);
  layOutLegend(&image, receivers.width, receivers.height, scale, title, entries);
  return image;
}

std::vector<float> truthVisibility(const Receivers& receivers, const Truth& truth) {
  std::vector<float> visibility(truth.lit.size());
  for (size_t i = 0; i < visibility.size(); ++i)
    visibility[i] = receivers.states[i] == PixelState::Empty || truth.lit[i] != 0 ? 1.0f : 0.0f;
  return visibility;
}

Image8 visibilityPicture(const Receivers& receivers, std::span<const float> visibility) {
  Image8 image(receivers.width, receivers.height, 3);
  for (int y = 0; y < receivers.height; ++y) {
    for (int x = 0; x < receivers.width; ++x) {
      const size_t i = static_cast<size_t>(y) * receivers.width + x;
      glm::u8vec3 color(static_cast<uint8_t>(std::lround(255.0f * std::clamp(visibility[i], 0.0f, 1.0f))));
      if (visibility[i] < 0.0f)
        color = {255, 0, 255};
      else if (receivers.states[i] == PixelState::Empty)
        color = kNothing;
      else if (receivers.states[i] == PixelState::FacingAway || receivers.states[i] == PixelState::OutsideCone)
        color = kDark;
      setPixel(image, x, y, color);
    }
  }
  return image;
}

Image8 differencePicture(const Receivers& receivers, std::span<const float> visibility, std::span<const float> truth) {
  Image8 image(receivers.width, receivers.height, 3);
  for (size_t i = 0; i < truth.size(); ++i) {
    glm::vec3 color(kNothing);
    if (receivers.states[i] == PixelState::FacingAway || receivers.states[i] == PixelState::OutsideCone)
      color = glm::vec3(kDark);
    if (receivers.states[i] == PixelState::Scored) {
      const float difference = std::max(visibility[i], 0.0f) - truth[i];
      const glm::vec3 strong(labelColor(difference > 0.0f ? Label::Leak : Label::Acne));
      const glm::vec3 calm = glm::mix(glm::vec3(kAgreeShadow), glm::vec3(kAgreeLit), truth[i]);
      color = glm::mix(calm, strong, std::sqrt(std::abs(difference)));
    }
    for (int c = 0; c < 3; ++c) image.values[3 * i + c] = static_cast<uint8_t>(std::lround(color[c]));
  }
  return image;
}

Image8 depthPicture(const ImageF& metres) {
  float nearest = std::numeric_limits<float>::infinity();
  float farthest = 0.0f;
  for (const float d : metres.values) {
    if (!std::isfinite(d)) continue;
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  Image8 image(metres.width, metres.height, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float d = *metres.at(x, y);
      const float t = std::clamp((d - nearest) / std::max(farthest - nearest, 1e-9f), 0.0f, 1.0f);
      const glm::u8vec3 grey(static_cast<uint8_t>(std::lround(245.0f - 215.0f * t)));
      setPixel(image, x, y, std::isfinite(d) ? grey : kNothing);
    }
  }
  return image;
}

}  // namespace gnomon
