#include "view/pixel_facts.h"

#include "scene/triangle_ids.h"
#include "truth/tracer.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

size_t indexOf(const ViewPicture& picture, glm::ivec2 pixel) {
  return static_cast<size_t>(pixel.y) * static_cast<size_t>(picture.width) + static_cast<size_t>(pixel.x);
}

bool isWithin(const ViewPicture& picture, glm::ivec2 pixel) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < picture.width && pixel.y < picture.height;
}

std::string nameOf(const Scene& scene, const Primitive& primitive) {
  const Instance& instance = scene.instances[primitive.instance];
  const std::string& name =
      instance.name.empty() ? scene.meshes[static_cast<size_t>(instance.mesh)].name : instance.name;
  return fmt::format("'{}', triangle {}", name, primitive.triangle);
}

const char* reasonOf(Label label) {
  switch (label) {
    case Label::Acne:
      return "the surface goes on without a gap between the two rays: nothing there casts a shadow, the bias was too "
             "small";
    case Label::Leak:
      return "the texel's ray meets an occluder before the receiver's plane: the bias reached past it";
    case Label::EdgeShadow:
      return "a silhouette lies between the two rays: the map is too coarse here";
    case Label::EdgeLight:
      return "the texel's ray misses the occluder: the map is too coarse here";
    case Label::Uncovered:
      return "the map does not cover this point";
    case Label::Agree:
      return "as the exact shadow says";
    case Label::NotScored:
      break;
  }
  return "";
}

std::string stateText(PixelState state) {
  switch (state) {
    case PixelState::Empty:
      return "no surface";
    case PixelState::FacingAway:
      return "the surface faces away from the light: dark in any map, not scored";
    case PixelState::OutsideCone:
      return "outside of the spot's cone: not scored";
    case PixelState::Scored:
      break;
  }
  return "";
}

float depthAt(const ImageF& depths, const FittedMap& fitted, const TexelPlace& place) {
  const int x = place.slice * fitted.map.width + place.texel.x;
  if (x >= depths.width || place.texel.y >= depths.height) return std::nanf("");
  return *depths.at(x, place.texel.y);
}

std::string metres(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g} m", value) : std::string("nothing");
}

std::string shortMetres(double value) {
  return value < 1.0 ? fmt::format("{:.3g} mm", 1e3 * value) : fmt::format("{:.4g} m", value);
}

std::string walksText(const glsl::PixelDiagnosis& pixel) {
  constexpr std::array kEnds = {
      "the receiver", "a surface that shadows it", "a surface behind it", "a hole", "an open edge", "a fold"};
  std::string text;
  for (size_t end = 0; end < kEnds.size(); ++end)
    if (const uint32_t count = pixel.walkEnds >> (5 * end) & 31u; count > 0)
      text += fmt::format("{}{} at {}", text.empty() ? "" : ", ", count, kEnds[end]);
  if (const uint32_t aborted = pixel.walkSteps >> 20; aborted > 0)
    text += fmt::format("{}{} given up", text.empty() ? "" : ", ", aborted);
  if (text.empty()) return "";
  return fmt::format("walks end: {}; {} triangles entered", text, pixel.walkSteps & 4095u);
}

// As depthInMetres() tells what a texel holds: from the light, or of a directional one from the map's plane.
double metresFromLight(const FittedMap& fitted, const glm::dvec3& pointW) {
  const glm::dvec3 away = pointW - glm::dvec3(fitted.frame.originW);
  return fitted.positional ? glm::length(away) : -glm::dot(away, glm::dvec3(fitted.frame.backW));
}

void addTexelFacts(std::vector<std::string>& facts, const ViewPicture& picture, const SidePicture& side, size_t index,
                   const TexelPlace& place, const SurfaceSample& sample) {
  const FittedMap& fitted = *side.fitted;
  const uint32_t word = side.diagnosis[index].texel;
  facts.push_back(fmt::format("texel {}, {} of slice {} ({} x {})", place.texel.x, place.texel.y, place.slice,
                              fitted.map.width, fitted.map.height));
  const RayD ray = texelRayW(fitted, word);
  const double approach = glm::dot(sample.normalW, ray.dir);
  const double plane = approach != 0.0 ? glm::dot(sample.normalW, sample.positionW - ray.origin) / approach : -1.0;
  if (side.depths) {
    const double first = static_cast<double>(depthAt(side.depths->first, fitted, place));
    const double own = metresFromLight(fitted, sample.positionW);
    std::string held = "it holds " + metres(first);
    if (side.depths->second)
      held += fmt::format(", then {}", metres(static_cast<double>(depthAt(*side.depths->second, fitted, place))));
    if (std::isfinite(first))
      held +=
          fmt::format("; the pixel is {} {}", shortMetres(std::abs(own - first)), own > first ? "behind" : "before");
    facts.push_back(held);
  }
  if (index < side.held.size() && side.held[index].instancePlusOne != 0)
    facts.push_back("it names " +
                    nameOf(picture.traced->scene, {side.held[index].instancePlusOne - 1, side.held[index].triangle}));
  facts.push_back(plane > 0.0 ? fmt::format("its ray meets the receiver's plane at {:.6g} m",
                                            metresFromLight(fitted, ray.origin + ray.dir * plane))
                              : std::string("its ray never meets the receiver's plane"));
  const std::optional<SurfaceHit> hit = picture.traced->tracer.firstHit(ray);
  facts.push_back(hit ? fmt::format("and first {} at {:.6g} m", nameOf(picture.traced->scene, hit->primitive),
                                    metresFromLight(fitted, ray.origin + ray.dir * hit->distance))
                      : std::string("and no surface"));
}

}  // namespace

std::optional<TexelPlace> texelOf(const ViewPicture& picture, int side, glm::ivec2 pixel) {
  const SidePicture& drawn = picture.sides[static_cast<size_t>(side)];
  if (!isWithin(picture, pixel) || drawn.diagnosis.empty() || !drawn.fitted) return std::nullopt;
  const glsl::PixelDiagnosis& diagnosis = drawn.diagnosis[indexOf(picture, pixel)];
  const uint32_t asked = glsl::kPixelShaded | glsl::kPixelCovered;
  if ((diagnosis.flags & asked) != asked) return std::nullopt;
  return TexelPlace{.slice = glsl::unpackSlice(diagnosis.texel), .texel = glsl::unpackTexel(diagnosis.texel)};
}

glm::ivec2 placeInUnfolded(const FittedMap& fitted, const TexelPlace& place) {
  const glm::ivec2 square =
      fitted.unfoldedAt.empty() ? glm::ivec2(place.slice, 0) : fitted.unfoldedAt[static_cast<size_t>(place.slice)];
  return square * glm::ivec2(fitted.map.width, fitted.map.height) + place.texel;
}

std::optional<TexelPlace> texelAtUnfolded(const FittedMap& fitted, glm::ivec2 place) {
  if (place.x < 0 || place.y < 0) return std::nullopt;
  const glm::ivec2 square(place.x / fitted.map.width, place.y / fitted.map.height);
  for (int slice = 0; slice < fitted.map.sliceCount; ++slice) {
    const glm::ivec2 at =
        fitted.unfoldedAt.empty() ? glm::ivec2(slice, 0) : fitted.unfoldedAt[static_cast<size_t>(slice)];
    if (at == square)
      return TexelPlace{.slice = slice, .texel = {place.x % fitted.map.width, place.y % fitted.map.height}};
  }
  return std::nullopt;
}

namespace {

// What one side says, and why.
void addMethodFacts(std::vector<std::string>& facts, const ViewPicture& picture, int side, glm::ivec2 pixel) {
  const SidePicture& drawn = picture.sides[static_cast<size_t>(side)];
  const size_t index = indexOf(picture, pixel);
  const Receivers& receivers = drawn.exact->receivers;
  const std::string name = fmt::format("{} {} {}", "AB"[side], drawn.map->name(), drawn.bias->name);
  if (receivers.states[index] != PixelState::Scored) {
    facts.push_back(fmt::format("{}: {}", name, stateText(receivers.states[index])));
    return;
  }
  const Label label = drawn.judged->labels.labels[index];
  facts.push_back(fmt::format("{}: {}, {}; exact shadow: {}", name,
                              drawn.judged->visibility[index] > 0.5f ? "lit" : "in shadow", labelName(label),
                              drawn.exact->truth.lit[index] != 0 ? "lit" : "in shadow"));
  if (const auto place = texelOf(picture, side, pixel)) {
    addTexelFacts(facts, picture, drawn, index, *place, receivers.samples[index]);
    if (const std::string walks = walksText(drawn.diagnosis[index]); !walks.empty()) facts.push_back(walks);
  }
  facts.emplace_back(reasonOf(label));
}

bool isKnown(const SidePicture& side) {
  return side.exact && side.judged && side.map != nullptr;
}

}  // namespace

std::vector<std::string> pixelFacts(const ViewPicture& picture, int side, glm::ivec2 pixel) {
  const SidePicture& drawn = picture.sides[static_cast<size_t>(side)];
  std::vector<std::string> facts = {fmt::format("pixel {}, {}", pixel.x, pixel.y)};
  if (isWithin(picture, pixel) && pixel.x < drawn.image.width && pixel.y < drawn.image.height) {
    const uint8_t* rgb = drawn.image.at(pixel.x, pixel.y);
    facts.back() += fmt::format(": {} {} {} of 255", rgb[0], rgb[1], rgb[2]);
  }
  if (!isWithin(picture, pixel) || !isKnown(drawn)) {
    facts.emplace_back("more is known when the picture is at rest");
    return facts;
  }
  const size_t index = indexOf(picture, pixel);
  const Receivers& receivers = drawn.exact->receivers;
  if (receivers.states[index] != PixelState::Empty) {
    const SurfaceSample& sample = receivers.samples[index];
    const glm::dvec3 at = sample.positionW + picture.traced->scene.originW;
    facts.push_back(fmt::format("{} at {:.4g}, {:.4g}, {:.4g} m", nameOf(picture.traced->scene, sample.primitive), at.x,
                                at.y, at.z));
  }
  addMethodFacts(facts, picture, side, pixel);
  if (isKnown(picture.sides[static_cast<size_t>(1 - side)])) addMethodFacts(facts, picture, 1 - side, pixel);
  return facts;
}

std::string countsLine(const ViewCounts& counts) {
  const auto count = [&](Label label) { return counts.labels[static_cast<size_t>(label)]; };
  const auto told = [&](size_t pixels) {
    const double share =
        counts.scored == 0 ? 0.0 : 100.0 * static_cast<double>(pixels) / static_cast<double>(counts.scored);
    const std::string percent = share > 0.0 && share < 0.01 ? "<0.01%" : fmt::format("{:.2f}%", share);
    return counts.share < 1.0 ? "about " + percent : fmt::format("{} ({})", pixels, percent);
  };
  return fmt::format("acne {}, leak {}, edges {}, uncovered {}; of {} scored{}", told(count(Label::Acne)),
                     told(count(Label::Leak)), told(count(Label::EdgeShadow) + count(Label::EdgeLight)),
                     told(count(Label::Uncovered)), counts.scored, counts.share < 1.0 ? ", from fewer pixels" : "");
}

}  // namespace gnomon
