#include "truth/labels.h"

#include "base/check.h"

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

bool liesBefore(const Probe& texel, const SurfaceSample& receiver, double receiverDistance, double margin) {
  if (!texel.hit) return false;
  if (glm::dot(receiver.normalW, texel.ray.dir) >= 0.0) return texel.hit->distance < receiverDistance - margin;
  return glm::dot(receiver.normalW, texel.positionW() - receiver.positionW) > margin;
}

// Of a pixel where prediction and truth differ. The pixel's own ray is not traced: what it hits first, where there is
// light, is the pixel's own triangle, and a ray that ends on an edge would say so only half of the time.
Label labelWrong(const Tracer& tracer, const LightRays& rays, const SurfaceSample& receiver, bool lit, double margin,
                 const RayD& texelRay) {
  const LightRay own = rays.towards(receiver.positionW);
  const Probe texel = probeAlong(tracer, rays.normalized(texelRay));
  if (!lit) return liesBefore(texel, receiver, own.distance, margin) ? Label::Leak : Label::EdgeLight;
  const Probe pixel{own.ray, SurfaceHit{own.distance, receiver.primitive, receiver.normalW}};
  return continuousBetween(tracer, texel, pixel, margin) ? Label::Acne : Label::EdgeShadow;
}

}  // namespace

const char* labelName(Label label) {
  switch (label) {
    case Label::NotScored:
      return "not_scored";
    case Label::Agree:
      return "agree";
    case Label::Acne:
      return "acne";
    case Label::Leak:
      return "leak";
    case Label::EdgeShadow:
      return "edge_shadow";
    case Label::EdgeLight:
      return "edge_light";
    case Label::Uncovered:
      return "uncovered";
  }
  detail::checkFailed(__FILE__, __LINE__, "label", fmt::format("{}", static_cast<int>(label)));
}

LabelImage labelPixels(const Tracer& tracer, const LightModel& light, const Receivers& receivers, const Truth& truth,
                       std::span<const Verdict> verdicts, const std::function<RayD(size_t pixel)>& texelRay) {
  const size_t pixelCount = receivers.states.size();
  GNOMON_CHECK_EQ(verdicts.size(), pixelCount);
  GNOMON_CHECK_EQ(truth.lit.size(), pixelCount);
  const LightRays rays(tracer.boundsW(), light);
  LabelImage image;
  image.labels.assign(pixelCount, Label::NotScored);
  tbb::parallel_for(size_t{0}, pixelCount, [&](size_t pixel) {
    if (receivers.states[pixel] != PixelState::Scored) return;
    const bool lit = truth.lit[pixel] != 0;
    const Verdict verdict = verdicts[pixel];
    GNOMON_CHECK(verdict != Verdict::NotAsked);
    Label& label = image.labels[pixel];
    if (verdict == Verdict::Uncovered) {
      label = Label::Uncovered;
    } else if ((verdict == Verdict::Lit) == lit) {
      label = Label::Agree;
    } else {
      label = labelWrong(tracer, rays, receivers.samples[pixel], lit, truth.margin, texelRay(pixel));
    }
  });
  for (const Label label : image.labels) ++image.counts[static_cast<size_t>(label)];
  return image;
}

}  // namespace gnomon
