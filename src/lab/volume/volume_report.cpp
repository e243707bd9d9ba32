#include "lab/volume/volume_report.h"

#include "lab/core/results_head.h"
#include "vsv/volume_parameterization.h"

#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::array kCauses = {BoundaryCause::Rounding, BoundaryCause::Outside, BoundaryCause::Silhouette,
                                BoundaryCause::Resolution};

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

double percent(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

double mebibytes(uint64_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

std::string line(const char* name, const std::string& text) {
  return fmt::format("{:<10} {}\n", name, text);
}

std::string bucketName(size_t bucket) {
  const int first = bucketStart(bucket);
  const int last = 2 * first - 1;
  return first < 2 ? std::to_string(first) : fmt::format("{}-{}", first, last);
}

std::string rangeText(float lower, float step, int count) {
  return fmt::format("{:.1f}..{:.1f}", degrees(lower), degrees(lower + static_cast<double>(count) * step));
}

std::string histogramTable(const BoundaryErrors& errors) {
  std::string text = fmt::format("{:>12}{:>10}{:>9}", "voxels off", "columns", "share");
  for (const BoundaryCause cause : kCauses) text += fmt::format("{:>12}", boundaryCauseName(cause));
  text += "\n";
  for (size_t bucket = 0; bucket < errors.histogram.size(); ++bucket) {
    if (errors.histogram[bucket] == 0) continue;
    text += fmt::format("{:>12}{:>10}{:>8.3f}%", bucketName(bucket), errors.histogram[bucket],
                        percent(errors.histogram[bucket], errors.columns));
    for (const BoundaryCause cause : kCauses) {
      const uint64_t count = errors.byCause[static_cast<size_t>(cause)][bucket];
      text += bucket == 0 ? fmt::format("{:>12}", "-") : fmt::format("{:>12}", count);
    }
    text += "\n";
  }
  return text;
}

std::string validationText(const VolumeValidation& v) {
  const OccluderCheck& occluders = v.source.occluders;
  std::string text =
      line("same map", fmt::format("{} voxels: {} mismatches, {} within the tolerance", v.source.sameMap.voxels,
                                   v.source.sameMap.mismatches, v.source.sameMap.withinTolerance)) +
      line("  columns", fmt::format("{} occluders: {} equal, {} within the tolerance, {} beyond; largest "
                                    "difference {:.2g} rad; {} between texels",
                                    occluders.columns, occluders.equal, occluders.withinTolerance, occluders.beyond,
                                    occluders.largest, v.source.betweenTexels)) +
      line("  scan",
           fmt::format("{} mismatches from the GPU's own occluders, {} within the tolerance; {} lit "
                       "behind an occluded voxel",
                       v.source.sameOccluders.mismatches, v.source.sameOccluders.withinTolerance, v.litBehind)) +
      line("exact", fmt::format("{} columns, {:.3f}% with the exact boundary; {} voxels too dark ({:.4f}%), {} too "
                                "light ({:.4f}%)",
                                v.exact.columns, percent(v.exact.histogram[0], v.exact.columns), v.exact.tooDark,
                                percent(v.exact.tooDark, v.source.sameMap.voxels), v.exact.tooLight,
                                percent(v.exact.tooLight, v.source.sameMap.voxels)));
  return text + histogramTable(v.exact);
}

std::string timesText(const VolumeTimes& times, bool validated, bool traced, bool wroteVdb) {
  std::string text = fmt::format("fit {:.1f}, build {:.1f} (bits {:.1f}), read back {:.1f}, grid {:.1f}", times.fit,
                                 times.build, times.bits, times.download, times.grid);
  if (traced) text += fmt::format(", trace {:.1f}", times.trace);
  if (validated) text += fmt::format(", same map {:.1f}, exact {:.1f}", times.implied, times.compareExact);
  if (wroteVdb) text += fmt::format(", file {:.1f}", times.vdb);
  return text + " ms";
}

Json rangeJson(float lower, float step, int count) {
  return {{"lower", lower}, {"step", step}, {"count", count}};
}

Json bitsJson(const BitsCheck& check) {
  return {{"voxels", check.voxels}, {"mismatches", check.mismatches}, {"within_tolerance", check.withinTolerance}};
}

// Buckets from 0 on to the last that is not empty.
Json histogramJson(const BoundaryErrors& errors) {
  Json json = Json::array();
  for (size_t bucket = 0; bucket < errors.histogram.size(); ++bucket) {
    Json entry = {{"voxels", bucketName(bucket)}, {"columns", errors.histogram[bucket]}};
    if (bucket > 0)
      for (const BoundaryCause cause : kCauses)
        entry[boundaryCauseName(cause)] = errors.byCause[static_cast<size_t>(cause)][bucket];
    json.push_back(entry);
  }
  return json;
}

void addValidation(Json& json, const VolumeValidation& v) {
  json["same_map"] = bitsJson(v.source.sameMap);
  const OccluderCheck& occluders = v.source.occluders;
  json["same_map"]["occluders"] = {
      {"columns", occluders.columns}, {"equal", occluders.equal},     {"within_tolerance", occluders.withinTolerance},
      {"beyond", occluders.beyond},   {"largest", occluders.largest}, {"between_texels", v.source.betweenTexels}};
  json["same_occluders"] = bitsJson(v.source.sameOccluders);
  json["same_occluders"]["lit_behind"] = v.litBehind;
  json["exact"] = {{"columns", v.exact.columns},
                   {"too_dark", v.exact.tooDark},
                   {"too_light", v.exact.tooLight},
                   {"both_dark", v.exactDifference.both},
                   {"histogram", histogramJson(v.exact)}};
}

Json timesJson(const VolumeResult& result) {
  const VolumeTimes& times = result.times;
  Json json = {{"fit_ms", times.fit}, {"build_ms", times.build}, {"bits_ms", times.bits}};
  json["read_back_ms"] = times.download;
  json["grid_ms"] = times.grid;
  if (result.validation) {
    json["trace_ms"] = times.trace;
    json["same_map_ms"] = times.implied;
    json["exact_ms"] = times.compareExact;
  }
  if (result.vdb) json["vdb_ms"] = times.vdb;
  return json;
}

Json vec3Json(const glm::vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

}  // namespace

std::string volumeTable(const Session& session, const VolumeOptions& options, const VolumeResult& result) {
  const glsl::EpipolarGrid& grid = result.columns.map.epipolar;
  std::string text =
      line("scene", fmt::format("{}, {} triangles; light '{}'; camera '{}'", session.scene().name,
                                triangleCount(session.scene()), result.light.name, session.camera().name)) +
      line("volume", fmt::format("{} x {} x {} (alpha x theta x phi), {}{}, {}", grid.alphaCount, grid.thetaCount,
                                 grid.phiCount, options.map.text(kVolumeSource),
                                 options.map.get(kVolumeSource) == VolumeSource::Resample
                                     ? fmt::format(" from a cube map of side {}", options.mapSide)
                                     : std::string(),
                                 options.map.text(kVolumeFit))) +
      line("ranges", fmt::format("alpha {}, theta {}, phi {} degrees; light to eye {:.4g} m",
                                 rangeText(grid.alphaLower, grid.alphaStep, grid.alphaCount),
                                 rangeText(grid.thetaLower, grid.thetaStep, grid.thetaCount),
                                 rangeText(grid.phiLower, grid.phiStep, grid.phiCount), grid.eyeDistance)) +
      line("voxels", fmt::format("{}, {:.2f}% occluded", result.voxels, percent(result.occluded, result.voxels)));
  if (result.validation) text += validationText(*result.validation);
  text += line("memory", fmt::format("dense {:.1f} MiB, OpenVDB {:.1f} MiB: {:.1f} times less ({} tiles, {} "
                                     "leaves)",
                                     mebibytes(result.denseBytes), mebibytes(result.gridBytes),
                                     static_cast<double>(result.denseBytes) / static_cast<double>(result.gridBytes),
                                     result.gridTiles, result.gridLeaves));
  if (result.vdb)
    text +=
        line("file", fmt::format("{}: {:.1f} MiB; density of {:.4g} m voxels, {} in shadow", options.vdb.string(),
                                 mebibytes(result.vdb->fileBytes), result.vdb->voxelMetres, result.vdb->densityVoxels));
  const bool traced = result.validation || !result.pictures.empty();
  return text + line("times", timesText(result.times, result.validation.has_value(), traced, result.vdb.has_value()));
}

std::string volumeJson(const Session& session, const VolumeOptions& options, const VolumeResult& result) {
  const glsl::EpipolarGrid& grid = result.columns.map.epipolar;
  const glsl::LightFrame& frame = result.columns.frame;
  Json json;
  json["schema"] = kVolumeReportVersion;
  json["gnomon"] = {{"version", gnomonVersion()},
                    {"device", session.device().info().name},
                    {"driver", session.device().info().driver}};
  json["command"] = options.command;
  json["scene"] = {{"name", session.scene().name}, {"triangles", triangleCount(session.scene())}};
  json["light"] = {{"name", result.light.name}, {"position", vec3Json(frame.originW)}};
  json["camera"] = {{"name", session.camera().name}, {"eye", vec3Json(session.view().eyeW)}};
  json["volume"] = {{"source", options.map.text(kVolumeSource)},
                    {"fit", options.map.text(kVolumeFit)},
                    {"alpha", rangeJson(grid.alphaLower, grid.alphaStep, grid.alphaCount)},
                    {"theta", rangeJson(grid.thetaLower, grid.thetaStep, grid.thetaCount)},
                    {"phi", rangeJson(grid.phiLower, grid.phiStep, grid.phiCount)},
                    {"voxels", result.voxels},
                    {"occluded", result.occluded}};
  if (options.map.get(kVolumeSource) == VolumeSource::Resample) json["volume"]["map_size"] = options.mapSide;
  if (result.validation) addValidation(json, *result.validation);
  json["memory"] = {{"dense_bytes", result.denseBytes},
                    {"openvdb_bytes", result.gridBytes},
                    {"tiles", result.gridTiles},
                    {"leaves", result.gridLeaves}};
  if (result.vdb)
    json["vdb"] = {{"file", options.vdb.string()},
                   {"bytes", result.vdb->fileBytes},
                   {"voxel_metres", result.vdb->voxelMetres},
                   {"density_voxels", result.vdb->densityVoxels}};
  json["pictures"] = Json::object();
  for (const auto& [name, path] : result.pictures) json["pictures"][name] = path;
  json["times"] = timesJson(result);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon
