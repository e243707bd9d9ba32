#pragma once
// Labels each wrong pixel of a shadow map with the reason, by ray tracing.
//
//   agree        prediction = truth
//   acne         predicted shadow where there is light, and the surface is continuous, seen from the light,
//                between the texel centre's ray and the pixel's: nothing there casts a shadow. The bias failed
//   leak         predicted light where there is shadow, although the first hit along the texel centre's ray
//                lies before the receiver's plane: the map held the occluder, the bias stepped over it
//   edge_shadow  predicted shadow where there is light, across a silhouette: the map is too coarse there
//   edge_light   predicted light where there is shadow, and no leak
//   uncovered    the map does not cover the pixel
//
// Acne and leak are bias errors; edges come from the map's resolution. "Before" means by more than the end margin of
// the ground truth's rays.

#include "truth/continuity.h"
#include "truth/visibility.h"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

enum class Label : uint8_t { NotScored, Agree, Acne, Leak, EdgeShadow, EdgeLight, Uncovered };
inline constexpr int kLabelCount = 7;
const char* labelName(Label label);  // "agree", "edge_shadow", ...

// What an unfiltered map said of a pixel.
enum class Verdict : uint8_t { NotAsked, Lit, Shadow, Uncovered };

// Of a pixel with the label leak or edge_light: whether a map that names triangles could have told.
enum class Unseen : uint8_t {
  Nothing,   // a texel near names a triangle that shadows the pixel; or the pixel has another label
  Triangle,  // none does, but one names another triangle of the same connected surface
  Surface,   // no texel near sees anything of what shadows it: it is thinner than their spacing
};

struct UnseenOccluders {
  std::vector<Unseen> of;  // one a pixel
  size_t occluders = 0;    // pixels whose occluder is named by no texel
  size_t surfaces = 0;     // of these, those whose occluder's surface is named by none
};

struct LabelImage {
  std::vector<Label> labels;  // one a pixel
  std::array<size_t, kLabelCount> counts{};
  std::optional<UnseenOccluders> unseen;  // of a bias that reads ids (judge/unseen_occluders.h)
  size_t count(Label label) const { return counts[static_cast<size_t>(label)]; }
};

// `texelRay(pixel)`: the light ray through the centre of the texel that decided the pixel, in W. Asked for
// wrong pixels only, from many threads at once. Every scored pixel needs a verdict other than NotAsked.
LabelImage labelPixels(const Tracer& tracer, const LightModel& light, const Receivers& receivers, const Truth& truth,
                       std::span<const Verdict> verdicts, const std::function<RayD(size_t pixel)>& texelRay);

}  // namespace gnomon
