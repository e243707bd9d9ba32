#include "lab/fog/fog_report.h"

#include "lab/core/results_head.h"
#include "lab/results/results_file.h"

#include <algorithm>
#include <cmath>

#include <glm/gtx/component_wise.hpp>

#include <fmt/format.h>

namespace gnomon {

namespace {

// "0.01" where it is grey, else "0.01, 0.02, 0.03".
std::string spectrumText(const glm::vec3& v) {
  if (v.x == v.y && v.x == v.z) return fmt::format("{:.4g}", v.x);
  return fmt::format("{:.4g}, {:.4g}, {:.4g}", v.x, v.y, v.z);
}

std::string lightsText(const FogView& view) {
  std::string text;
  for (size_t i = 0; i < view.lights.size(); ++i)
    text +=
        fmt::format("{}'{}' {} cd", i == 0 ? "" : "; ", view.lights[i].name, spectrumText(view.sources[i].intensity));
  return text;
}

std::string referenceText(const FogResult& result) {
  const MediaReference& reference = *result.reference;
  const double pixels = static_cast<double>(reference.inScattered.values.size() / 3);
  const double perPixel = static_cast<double>(reference.rays) / pixels;
  std::string text = fmt::format(
      "mean {:.4g} cd/m^2; the last doubling of samples changed no pixel by more than {:.2g} of it (tolerance "
      "{:.2g}; {:.0f} rays a pixel, at most {} doublings",
      reference.mean, reference.worstChange, reference.bound, perPixel, reference.doublings);
  if (!(reference.mean > 0.0)) text += "; it is black: errors are absolute, cd/m^2";
  if (reference.atLimit > 0) text += fmt::format("; {} pixels reached that limit", reference.atLimit);
  return text +
         fmt::format("; {}{:.1f} s)", result.referenceFromCache ? "cached, from a run of " : "", reference.ms / 1000.0);
}

// Of a row, with or without builds: both measures in one line.
std::string termsText(const FogResult& result) {
  if (result.equalTerms.empty()) return "";
  std::string text = fmt::format("{:<35}{:>28}{:>32}\n{:<35}{:>16}{:>12}{:>20}{:>12}\n",
                                 "against " + result.equalTerms.front().against, "times faster at equal error",
                                 "times less error at equal time", "", "rel rmse", "rmse 99%", "rel rmse", "rmse 99%");
  for (const MediaRow& row : result.rows) {
    if (row.isBaseline) continue;
    for (const bool withBuild : {true, false}) {
      const auto factor = [&](ErrorMeasure measure, Factor EqualTerms::*which) -> std::string {
        const EqualTerms* terms = findTerms(result.equalTerms, row.name(), withBuild, measure);
        return terms != nullptr ? factorText(terms->*which) : "-";
      };
      text += fmt::format(
          "{:<13}{:<22}{:>16}{:>12}{:>20}{:>12}\n", row.name(), withBuild ? "map, table, integral" : "integral alone",
          factor(ErrorMeasure::RelRmse, &EqualTerms::faster), factor(ErrorMeasure::RelRmse99, &EqualTerms::faster),
          factor(ErrorMeasure::RelRmse, &EqualTerms::better), factor(ErrorMeasure::RelRmse99, &EqualTerms::better));
    }
  }
  return text +
         ">=: the march does not reach that error, or is not that fast, with the step counts tried; <=: it is better "
         "or faster with all of them\n";
}

LightFacts lightFacts(const Light& light, const MediaLightSource& source) {
  LightFacts facts{.name = light.name,
                   .type = light.type == LightType::Spot ? "spot" : "point",
                   .position = light.positionW,
                   .intensity = source.intensity};
  if (light.type == LightType::Spot) {
    facts.direction = glm::vec3(source.coneAxisW);
    facts.coneDegrees = static_cast<float>(2.0 * glm::degrees(std::acos(source.coneCos)));
  }
  return facts;
}

MediumFacts mediumFacts(const FogView& view) {
  MediumFacts facts{
      .sigmaS = view.medium.sigmaS, .sigmaA = view.medium.sigmaA, .g = view.medium.g, .reach = view.medium.reach};
  if (view.density)
    facts.density = {.grid = view.density->gridName(),
                     .lower = glm::vec3(view.density->boundsW().lower),
                     .upper = glm::vec3(view.density->boundsW().upper),
                     .voxelMetres = static_cast<float>(view.density->voxelMetres()),
                     .voxels = view.density->activeVoxels()};
  return facts;
}

FramesFacts framesFacts(const FogMotion& motion, const FogResult& result) {
  std::string moves = !motion.moves() ? "" : motion.camera ? "camera" : "light";
  if (motion.densityAt) moves += moves.empty() ? "density" : " and density";
  FramesFacts facts{.count = result.framesDone,
                    .moves = moves,
                    .offset = motion.offsetW,
                    .note = result.motionNote,
                    .pictures = result.framePictures};
  if (motion.degrees != 0.0) {
    facts.axis = motion.axisW;
    facts.degrees = motion.degrees;
  }
  return facts;
}

ReferenceFacts referenceFacts(const FogResult& result) {
  const MediaReference& reference = *result.reference;
  return {.mean = reference.mean,
          .bound = reference.bound,
          .worstChange = reference.worstChange,
          .atLimit = reference.atLimit,
          .doublings = reference.doublings,
          .rays = reference.rays,
          .traceMs = reference.ms,
          .fromCache = result.referenceFromCache,
          .pictures = result.pictures};
}

}  // namespace

std::string fogTable(const Session& session, const FogOptions&, const FogResult& result) {
  const FogView& view = result.view;
  std::string text =
      fmt::format("{}: {} triangles, diagonal {:.4g} m; camera '{}', {} x {}; {}\n", session.scene().name,
                  triangleCount(session.scene()), computeBounds(session.scene()).diagonal(), session.camera().name,
                  session.view().width, session.view().height, session.device().info().name);
  text += fmt::format("light {}; medium: sigma_s {} and sigma_a {} per metre, g {:.3g}, view rays end at {:.4g} m\n",
                      lightsText(view), spectrumText(view.medium.sigmaS), spectrumText(view.medium.sigmaA),
                      view.medium.g, view.medium.reach);
  if (view.density)
    text += fmt::format(
        "density: grid '{}', {} voxels of {:.4g} m, from {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g}; "
        "the integrators of a volume are one there, which marches\n",
        view.density->gridName(), view.density->activeVoxels(), view.density->voxelMetres(),
        view.density->boundsW().lower.x, view.density->boundsW().lower.y, view.density->boundsW().lower.z,
        view.density->boundsW().upper.x, view.density->boundsW().upper.y, view.density->boundsW().upper.z);
  if (result.reference) text += fmt::format("reference: {}\n", referenceText(result));
  text += fmt::format("pictures are exposed by {:.6g} per cd/m^2 (--exposure keeps it for others)\n",
                      result.exposure.factor);
  const DeclaredColumns<MediaRow> columns(result.rows);
  text += fmt::format("{:<13}{:<22}{}\n", "integrator", "map", columns.head());
  for (const MediaRow& row : result.rows)
    text += fmt::format("{:<13}{:<22}{}\n", row.name(), row.map + " " + paramText(row.params, "map_size"),
                        columns.line(row));
  text += termsText(result);
  if (!result.motionNote.empty()) text += result.motionNote + "\n";
  return text;
}

std::string fogJson(const Session& session, const FogOptions& options, const FogResult& result,
                    const std::string& command) {
  MediaResults file;
  static_cast<ResultsHead&>(file) = resultsHead(session, command, result.gbufferMs);
  file.files = result.files;
  file.isComplete = result.isComplete;
  for (size_t i = 0; i < result.view.lights.size(); ++i)
    file.lights.push_back(lightFacts(result.view.lights[i], result.view.sources[i]));
  file.medium = mediumFacts(result.view);
  file.exposure = static_cast<double>(result.exposure.factor);
  if (result.reference) file.reference = referenceFacts(result);
  file.worst = result.worst;
  if (options.motion) file.frames = framesFacts(*options.motion, result);
  file.rows = result.rows;
  file.equalTerms = result.equalTerms;
  return resultsText(file);
}

}  // namespace gnomon
