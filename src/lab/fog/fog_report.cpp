#include "lab/fog/fog_report.h"

#include "lab/core/results_head.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>

#include <glm/gtx/component_wise.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

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
      "mean {:.4g} cd/m^2; the last doubling of a pixel's samples changed none by more than {:.2g} of it "
      "(bound {:.2g}; {:.0f} rays a pixel, at most {} doublings",
      reference.mean, reference.worstChange, reference.bound, perPixel, reference.doublings);
  if (reference.atLimit > 0) text += fmt::format("; {} pixels ran into that limit", reference.atLimit);
  return text +
         fmt::format("; {}{:.1f} s)", result.referenceFromCache ? "kept from a run of " : "", reference.ms / 1000.0);
}

std::string shareText(const std::optional<double>& share) {
  return share ? fmt::format("{:.5f}", *share) : "";
}

// Of a row, with or without builds: both measures in one line.
std::string termsText(const FogResult& result) {
  if (result.equalTerms.empty()) return "";
  std::string text = fmt::format("{:<35}{:>28}{:>32}\n{:<35}{:>16}{:>12}{:>20}{:>12}\n", "against march",
                                 "times faster at equal error", "times less error at equal time", "", "rel rmse",
                                 "rmse 99%", "rel rmse", "rmse 99%");
  const auto find = [&](size_t row, bool withBuild, ErrorMeasure measure, bool faster) -> std::string {
    for (const EqualTerms& terms : result.equalTerms)
      if (terms.row == row && terms.withBuild == withBuild && terms.measure == measure)
        return factorText(faster ? terms.faster : terms.better);
    return "-";
  };
  for (size_t row = 0; row < result.rows.size(); ++row) {
    for (const bool withBuild : {true, false}) {
      if (result.rows[row].method.integrator == Integrator::March) continue;
      text += fmt::format(
          "{:<13}{:<22}{:>16}{:>12}{:>20}{:>12}\n", mediaMethodName(result.rows[row].method),
          withBuild ? "map, table, integral" : "integral alone", find(row, withBuild, ErrorMeasure::RelRmse, true),
          find(row, withBuild, ErrorMeasure::RelRmse99, true), find(row, withBuild, ErrorMeasure::RelRmse, false),
          find(row, withBuild, ErrorMeasure::RelRmse99, false));
    }
  }
  return text +
         ">=: the march does not come to that error, or is not that fast, with the steps tried; <=: it is "
         "better or faster with all of them\n";
}

Json optionalJson(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json picturesJson(const Pictures& pictures) {
  Json json = Json::object();
  for (const auto& [name, path] : pictures) json[name] = path;
  return json;
}

Json lightJson(const Light& light, const MediaLightSource& source) {
  Json json = {{"name", light.name},
               {"type", light.type == LightType::Spot ? "spot" : "point"},
               {"position", vectorJson(light.positionW)},
               {"intensity", vectorJson(source.intensity)}};
  if (light.type == LightType::Spot) {
    json["direction"] = vectorJson(glm::vec3(source.coneAxisW));
    json["cone_degrees"] = shortest(static_cast<float>(2.0 * glm::degrees(std::acos(source.coneCos))));
  }
  return json;
}

Json mediumJson(const FogView& view) {
  Json density = nullptr;
  if (view.density)
    density = {{"grid", view.density->gridName()},
               {"lower", vectorJson(view.density->boundsW().lower)},
               {"upper", vectorJson(view.density->boundsW().upper)},
               {"voxel_metres", shortest(static_cast<float>(view.density->voxelMetres()))},
               {"voxels", view.density->activeVoxels()}};
  return {{"sigma_s", vectorJson(view.medium.sigmaS)},
          {"sigma_a", vectorJson(view.medium.sigmaA)},
          {"g", shortest(view.medium.g)},
          {"reach", shortest(view.medium.reach)},
          {"density", density}};
}

Json referenceJson(const FogResult& result) {
  if (!result.reference) return nullptr;
  const MediaReference& reference = *result.reference;
  return {{"mean", reference.mean},
          {"bound", reference.bound},
          {"worst_change", reference.worstChange},
          {"pixels_at_limit", reference.atLimit},
          {"doublings", reference.doublings},
          {"rays", reference.rays},
          {"trace_ms", reference.ms},
          {"from_cache", result.referenceFromCache},
          {"pictures", picturesJson(result.pictures)}};
}

Json rowJson(const MediaRow& row, const FogOptions& options, const FogResult& result) {
  Json params = {{"map_size", row.mapSize}, {"lights", result.view.lights.size()}};
  if (row.method.integrator != Integrator::March) {
    params["vsv_source"] = options.map.text(kVolumeSource);
    params["vsv_fit"] = options.map.text(kVolumeFit);
    if (options.map.get(kVolumeSource) == VolumeSource::Resample) params["cube_size"] = options.mapSide;
  }
  params["cull"] = cullModeName(options.cull);
  return {{"integrator", integratorName(row.method.integrator)},
          {"steps", row.method.steps > 0 ? Json(row.method.steps) : Json(nullptr)},
          {"map", row.map},
          {"params", params},
          {"rel_rmse", optionalJson(row.relRmse)},
          {"rel_rmse_99", optionalJson(row.relRmse99)},
          {"flip", optionalJson(row.flip)},
          {"flicker", optionalJson(row.flicker)},
          {"map_ms", row.mapMs},
          {"table_ms", row.tableMs},
          {"build_ms", row.buildMs()},
          {"integrate_ms", row.integrateMs},
          {"pictures", picturesJson(row.pictures)}};
}

Json factorJson(const Factor& factor) {
  const char* bound = factor.bound == Bound::AtLeast ? "at_least" : factor.bound == Bound::AtMost ? "at_most" : "exact";
  return {{"factor", factor.value}, {"bound", bound}};
}

Json termsJson(const EqualTerms& terms, const FogResult& result) {
  const MediaMethod& method = result.rows[terms.row].method;
  return {{"integrator", integratorName(method.integrator)},
          {"steps", method.steps > 0 ? Json(method.steps) : Json(nullptr)},
          {"against", "march"},
          {"with_build", terms.withBuild},
          {"measure", errorMeasureName(terms.measure)},
          {"faster_at_equal_error", factorJson(terms.faster)},
          {"less_error_at_equal_time", factorJson(terms.better)}};
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
        "runs, bits and popcount are one there, which marches\n",
        view.density->gridName(), view.density->activeVoxels(), view.density->voxelMetres(),
        view.density->boundsW().lower.x, view.density->boundsW().lower.y, view.density->boundsW().lower.z,
        view.density->boundsW().upper.x, view.density->boundsW().upper.y, view.density->boundsW().upper.z);
  if (result.reference) text += fmt::format("reference: {}\n", referenceText(result));
  const bool flickers = std::ranges::any_of(result.rows, [](const MediaRow& row) { return row.flicker.has_value(); });
  text += fmt::format("{:<13}{:<22}{:>10}{:>10}{:>10}{:>10}{:>10}{:>14}{:>10}{}\n", "integrator", "map", "rel rmse",
                      "rmse 99%", "flip", "map ms", "table ms", "integrate ms", "all ms", flickers ? "   flicker" : "");
  for (const MediaRow& row : result.rows) {
    text +=
        fmt::format("{:<13}{:<22}{:>10}{:>10}{:>10}{:>10.2f}{:>10.2f}{:>14.2f}{:>10.2f}", mediaMethodName(row.method),
                    row.map + " " + row.mapSize, shareText(row.relRmse), shareText(row.relRmse99), shareText(row.flip),
                    row.mapMs, row.tableMs, row.integrateMs, row.totalMs());
    if (flickers) text += fmt::format("{:>10}", shareText(row.flicker));
    text += "\n";
  }
  text += termsText(result);
  if (!result.motionNote.empty()) text += result.motionNote + "\n";
  return text;
}

std::string fogJson(const Session& session, const FogOptions& options, const FogResult& result,
                    const std::string& command) {
  Json json = resultsHead(session, session.setup(), command, result.gbufferMs);
  json["lights"] = Json::array();
  for (size_t i = 0; i < result.view.lights.size(); ++i)
    json["lights"].push_back(lightJson(result.view.lights[i], result.view.sources[i]));
  json["medium"] = mediumJson(result.view);
  json["exposure"] = result.exposure.factor;
  json["reference"] = referenceJson(result);
  json["worst_place"] =
      result.worst ? Json{{"x", result.worst->x}, {"y", result.worst->y}, {"size", result.worst->size}} : Json(nullptr);
  json["frames"] = options.motion ? Json{{"count", options.motion->frames},
                                         {"moves", options.motion->camera ? "camera" : "light"},
                                         {"offset", vectorJson(options.motion->offsetW)},
                                         {"note", result.motionNote}}
                                  : Json(nullptr);
  json["truths"] = json["maps"] = json["rows"] = Json::array();  // of gnomon compare
  json["media"] = Json::array();
  for (const MediaRow& row : result.rows) json["media"].push_back(rowJson(row, options, result));
  json["equal_terms"] = Json::array();
  for (const EqualTerms& terms : result.equalTerms) json["equal_terms"].push_back(termsJson(terms, result));
  return json.dump(2) + "\n";
}

}  // namespace gnomon
