#include "lab/picture/flip.h"

#include "base/error.h"
#include "lab/picture/magma.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/glm.hpp>

namespace gnomon {

namespace {

// Exponents and the colour error's redistribution: section 4.1.3 and 4.3, table of constants.
constexpr float kColorExponent = 0.7f;     // q_c
constexpr float kFeatureExponent = 0.5f;   // q_f
constexpr float kSmallColorError = 0.4f;   // p_c: share of the largest error that ...
constexpr float kSmallColorSpan = 0.95f;   // p_t: ... takes this share of [0,1]
constexpr double kFeatureDegrees = 0.082;  // w: width of the thinnest line seen as one, section 4.2

// The contrast sensitivity of the eye, eq. 6 and table 1, as a sum of two Gaussians in the plane:
// a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic = {1.0, 0.0047, 0.0, 1e-5};
constexpr Sensitivity kRedGreen = {1.0, 0.0053, 0.0, 1e-5};
constexpr Sensitivity kBlueYellow = {34.1, 0.04, 13.5, 0.025};
constexpr double kWidestB = 0.04;  // all filters take the widest one's support

// One plane of floats.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;
  Plane(int w, int h) : width(w), height(h), values(static_cast<size_t>(w) * h) {}
  float* row(int y) { return values.data() + static_cast<size_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<size_t>(y) * width; }
};

using Kernel = std::vector<float>;  // 2 radius + 1 taps

void forRows(int height, const auto& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, 16), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) body(y);
  });
}

// CIE XYZ of linear sRGB. The primaries are sRGB's, the white is D65 at (0.31271, 0.32902), Y of white is 1:
// columns are x, y, z of each primary times the weights that make them sum to the white.
struct XyzFromRgb {
  glm::dmat3 matrix;
  glm::vec3 white;
  XyzFromRgb() {
    const auto xyz = [](double x, double y) { return glm::dvec3(x / y, 1.0, (1.0 - x - y) / y); };
    const glm::dmat3 primaries(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    const glm::dvec3 whiteXyz = xyz(0.31271, 0.32902);
    const glm::dvec3 weights = glm::inverse(primaries) * whiteXyz;
    matrix = glm::dmat3(primaries[0] * weights.x, primaries[1] * weights.y, primaries[2] * weights.z);
    white = glm::vec3(whiteXyz);
  }
};
const XyzFromRgb kXyz;
const glm::mat3 kXyzFromRgb(kXyz.matrix);
const glm::mat3 kRgbFromXyz(glm::inverse(kXyz.matrix));

// YyCxCz, the linear opponent space of the filters: eq. 3.
glm::vec3 opponentFromXyz(const glm::vec3& xyz) {
  const glm::vec3 n = xyz / kXyz.white;
  return {116.0f * n.y - 16.0f, 500.0f * (n.x - n.y), 200.0f * (n.y - n.z)};
}

glm::vec3 xyzFromOpponent(const glm::vec3& opponent) {
  const float y = (opponent.x + 16.0f) / 116.0f;
  return glm::vec3(y + opponent.y / 500.0f, y, y - opponent.z / 200.0f) * kXyz.white;
}

// CIE L*a*b* with Hunt's adjustment (colours fade in the dark): eq. 9.
glm::vec3 huntLabFromRgb(const glm::vec3& rgb) {
  const glm::vec3 n = kXyzFromRgb * rgb / kXyz.white;
  const auto f = [](float t) {
    constexpr float delta = 6.0f / 29.0f;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
  };
  const float fy = f(n.y);
  const float lightness = 116.0f * fy - 16.0f;
  const float fade = 0.01f * lightness;
  return {lightness, fade * 500.0f * (f(n.x) - fy), fade * 200.0f * (fy - f(n.z))};
}

// HyAB: Abasi, Amani Tehran, Fairchild, "Distance metrics for very large color differences" (2020).
float hyab(const glm::vec3& a, const glm::vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

Kernel gaussian(int radius, double variance) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / variance)));
  return kernel;
}

// Positive taps sum to 1, negative ones to -1: an even plane gives 0, the steepest step 1.
Kernel balanced(Kernel kernel) {
  double positive = 0.0;
  double negative = 0.0;
  for (const float tap : kernel) (tap > 0.0f ? positive : negative) += std::abs(tap);
  for (float& tap : kernel) tap /= static_cast<float>(tap > 0.0f ? positive : std::max(negative, 1e-30));
  return kernel;
}

// Beyond the border stands the border's own pixel.
Plane convolveRows(const Plane& source, const Kernel& kernel) {
  const int radius = static_cast<int>(kernel.size()) / 2;
  Plane out(source.width, source.height);
  forRows(source.height, [&](int y) {
    std::vector<float> padded(static_cast<size_t>(source.width) + 2 * radius);
    const float* from = source.row(y);
    std::fill_n(padded.begin(), radius, from[0]);
    std::copy_n(from, source.width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + source.width, radius, from[source.width - 1]);
    float* to = out.row(y);
    for (size_t tap = 0; tap < kernel.size(); ++tap)
      for (int x = 0; x < source.width; ++x) to[x] += kernel[tap] * padded[x + tap];
  });
  return out;
}

Plane convolveColumns(const Plane& source, const Kernel& kernel) {
  const int radius = static_cast<int>(kernel.size()) / 2;
  Plane out(source.width, source.height);
  forRows(source.height, [&](int y) {
    float* to = out.row(y);
    for (int tap = -radius; tap <= radius; ++tap) {
      const float weight = kernel[tap + radius];
      const float* from = source.row(std::clamp(y + tap, 0, source.height - 1));
      for (int x = 0; x < source.width; ++x) to[x] += weight * from[x];
    }
  });
  return out;
}

// The sensitivity's two Gaussians, each separable; together their taps sum to 1.
Plane filterBySensitivity(const Plane& source, const Sensitivity& s, double pixelsPerDegree) {
  const double pi = std::numbers::pi;
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestB / (2.0 * pi * pi)) * pixelsPerDegree));
  const auto kernel = [&](double b) {
    return gaussian(radius, b / (2.0 * pi * pi) * pixelsPerDegree * pixelsPerDegree);
  };
  const auto planeSum = [](const Kernel& k) {
    double sum = 0.0;
    for (const float tap : k) sum += tap;
    return sum * sum;
  };
  const std::array kernels = {kernel(s.b1), kernel(s.b2)};
  const std::array weights = {s.a1 * std::sqrt(pi / s.b1), s.a2 * std::sqrt(pi / s.b2)};
  const double total = weights[0] * planeSum(kernels[0]) + weights[1] * planeSum(kernels[1]);
  Plane out(source.width, source.height);
  for (int i = 0; i < 2; ++i) {
    if (weights[i] == 0.0) continue;
    Plane filtered = convolveColumns(convolveRows(source, kernels[i]), kernels[i]);
    const float share = static_cast<float>(weights[i] / total);
    for (size_t p = 0; p < out.values.size(); ++p) out.values[p] += share * filtered.values[p];
  }
  return out;
}

struct Opponent {
  Plane achromatic, redGreen, blueYellow;
};

Opponent opponentFromSrgb(const Image8& image) {
  std::array<float, 256> linear;
  for (int i = 0; i < 256; ++i) linear[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
  Opponent out{Plane(image.width, image.height), Plane(image.width, image.height), Plane(image.width, image.height)};
  forRows(image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = image.at(x, y);
      const bool grey = image.channels == 1;
      const glm::vec3 rgb(linear[p[0]], linear[p[grey ? 0 : 1]], linear[p[grey ? 0 : 2]]);
      const glm::vec3 opponent = opponentFromXyz(kXyzFromRgb * rgb);
      out.achromatic.row(y)[x] = opponent.x;
      out.redGreen.row(y)[x] = opponent.y;
      out.blueYellow.row(y)[x] = opponent.z;
    }
  });
  return out;
}

// What the eye sees of a picture: filtered, back within the screen's colours, in L*a*b*.
std::vector<glm::vec3> perceived(const Opponent& picture, double pixelsPerDegree) {
  const Plane a = filterBySensitivity(picture.achromatic, kAchromatic, pixelsPerDegree);
  const Plane r = filterBySensitivity(picture.redGreen, kRedGreen, pixelsPerDegree);
  const Plane b = filterBySensitivity(picture.blueYellow, kBlueYellow, pixelsPerDegree);
  std::vector<glm::vec3> lab(a.values.size());
  forRows(a.height, [&](int y) {
    for (int x = 0; x < a.width; ++x) {
      const glm::vec3 xyz = xyzFromOpponent({a.row(y)[x], r.row(y)[x], b.row(y)[x]});
      const glm::vec3 rgb = glm::clamp(kRgbFromXyz * xyz, 0.0f, 1.0f);
      lab[static_cast<size_t>(y) * a.width + x] = huntLabFromRgb(rgb);
    }
  });
  return lab;
}

// Colour error in [0,1], eq. 10 and 11: small errors get most of the range.
float colorError(const glm::vec3& labA, const glm::vec3& labB, float largest) {
  const float error = std::pow(hyab(labA, labB), kColorExponent);
  const float small = kSmallColorError * largest;
  if (error < small) return kSmallColorSpan * error / small;
  return kSmallColorSpan + (error - small) / (largest - small) * (1.0f - kSmallColorSpan);
}

// Strength of edges and points, section 4.2: lengths of the first and second derivatives of the lightness.
struct Features {
  std::vector<float> edges, points;
};

Features findFeatures(Plane lightness, double pixelsPerDegree) {
  for (float& v : lightness.values) v = (v + 16.0f) / 116.0f;
  const double deviation = 0.5 * kFeatureDegrees * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  Kernel blur = gaussian(radius, deviation * deviation);
  Kernel slope = blur;
  Kernel bend = blur;
  double sum = 0.0;
  for (const float tap : blur) sum += tap;
  for (int i = -radius; i <= radius; ++i) {
    blur[i + radius] /= static_cast<float>(sum);
    slope[i + radius] *= static_cast<float>(-i);
    bend[i + radius] *= static_cast<float>(i * i / (deviation * deviation) - 1.0);
  }
  slope = balanced(slope);
  bend = balanced(bend);
  const auto lengths = [&](const Kernel& derivative) {
    const Plane alongX = convolveColumns(convolveRows(lightness, derivative), blur);
    const Plane alongY = convolveColumns(convolveRows(lightness, blur), derivative);
    std::vector<float> length(alongX.values.size());
    for (size_t i = 0; i < length.size(); ++i)
      length[i] = std::sqrt(alongX.values[i] * alongX.values[i] + alongY.values[i] * alongY.values[i]);
    return length;
  };
  return {lengths(slope), lengths(bend)};
}

// The value at which `share` of the sum of the sorted values is reached.
double weightedPercentile(std::span<const float> sorted, double sum, double share) {
  double running = 0.0;
  for (const float v : sorted) {
    running += static_cast<double>(v);
    if (running >= share * sum) return static_cast<double>(v);
  }
  return 0.0;
}

void pool(Flip& flip) {
  std::vector<float> sorted = flip.map.values;
  std::ranges::sort(sorted);
  double sum = 0.0;
  for (const float v : sorted) sum += static_cast<double>(v);
  flip.mean = sum / static_cast<double>(sorted.size());
  flip.max = static_cast<double>(sorted.back());
  flip.firstWeightedQuartile = weightedPercentile(sorted, sum, 0.25);
  flip.weightedMedian = weightedPercentile(sorted, sum, 0.5);
  flip.thirdWeightedQuartile = weightedPercentile(sorted, sum, 0.75);
}

}  // namespace

Flip computeFlip(const Image8& reference, const Image8& test, double pixelsPerDegree) {
  if (reference.width != test.width || reference.height != test.height || reference.values.empty())
    throw WorldError(fmt::format("FLIP of {} x {} and {} x {} pixels: give two pictures of one size", reference.width,
                                 reference.height, test.width, test.height));
  for (const Image8* image : {&reference, &test})
    if (image->channels == 2 || image->channels > 4)
      throw WorldError(fmt::format("FLIP of a picture with {} channels: give 1, 3 or 4", image->channels));

  const Opponent opponentA = opponentFromSrgb(reference);
  const Opponent opponentB = opponentFromSrgb(test);
  const Features featuresA = findFeatures(opponentA.achromatic, pixelsPerDegree);
  const Features featuresB = findFeatures(opponentB.achromatic, pixelsPerDegree);
  const std::vector<glm::vec3> labA = perceived(opponentA, pixelsPerDegree);
  const std::vector<glm::vec3> labB = perceived(opponentB, pixelsPerDegree);
  const float largest = std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kColorExponent);

  Flip flip{.map = ImageF(reference.width, reference.height, 1)};
  forRows(reference.height, [&](int y) {
    for (int x = 0; x < reference.width; ++x) {
      const size_t i = static_cast<size_t>(y) * reference.width + x;
      const float edge = std::abs(featuresA.edges[i] - featuresB.edges[i]);
      const float point = std::abs(featuresA.points[i] - featuresB.points[i]);
      // A feature's strength reaches sqrt(2): both derivatives of 1.
      const float feature = std::pow(std::max(edge, point) / std::numbers::sqrt2_v<float>, kFeatureExponent);
      flip.map.values[i] = std::pow(colorError(labA[i], labB[i], largest), 1.0f - feature);
    }
  });
  pool(flip);
  return flip;
}

Image8 flipPicture(const ImageF& map) {
  Image8 picture(map.width, map.height, 3);
  for (size_t i = 0; i < map.values.size(); ++i) {
    const long index = std::lround(255.0f * std::clamp(map.values[i], 0.0f, 1.0f));
    for (int c = 0; c < 3; ++c) picture.values[3 * i + c] = static_cast<uint8_t>(kMagma[index] >> (16 - 8 * c));
  }
  return picture;
}

}  // namespace gnomon
