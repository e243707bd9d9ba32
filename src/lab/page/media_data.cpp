#include "lab/page/media_data.h"

#include <algorithm>

namespace gnomon {

namespace {

// "0.04" where it is grey, else "0.01, 0.02, 0.04".
std::string spectrumText(const ReportField& field) {
  const std::vector<double> values = field.numbers();
  if (values.size() != 3) field.fail("must be a list of three numbers");
  if (std::ranges::all_of(values, [&](double v) { return v == values.front(); }))
    return fmt::format("{:.4g}", values.front());
  return vectorText(values);
}

std::string methodText(const std::string& integrator, const std::optional<uint64_t>& steps) {
  return steps ? fmt::format("{} {}", integrator, *steps) : integrator;
}

std::optional<uint64_t> readSteps(const ReportField& field) {
  return field.has("steps") ? std::optional(field["steps"].count()) : std::nullopt;
}

double readMs(const ReportField& row, const char* key) {
  const double ms = row[key].number();
  if (ms < 0.0) row[key].fail("must not be negative");
  return ms;
}

std::optional<double> readError(const ReportField& row, const char* key) {
  const std::optional<double> error = row.optionalNumber(key);
  if (error && *error < 0.0) row[key].fail("must not be negative");
  return error;
}

MediaDataRow readRow(const ReportField& field) {
  MediaDataRow row{.integrator = field["integrator"].text(),
                   .map = field["map"].text(),
                   .steps = readSteps(field),
                   .relRmse = readError(field, "rel_rmse"),
                   .relRmse99 = readError(field, "rel_rmse_99"),
                   .flip = readError(field, "flip"),
                   .flicker = readError(field, "flicker"),
                   .mapMs = readMs(field, "map_ms"),
                   .tableMs = readMs(field, "table_ms"),
                   .integrateMs = readMs(field, "integrate_ms"),
                   .pictures = field["pictures"].pictures()};
  field["params"].forMembers([&](const std::string& name, const ReportField& value) {
    row.params.push_back({name, value.anyText(), false});
  });
  return row;
}

MediaDataFactor readFactor(const ReportField& field) {
  MediaDataFactor factor{.factor = field["factor"].number(), .bound = field["bound"].text()};
  if (factor.bound != "exact" && factor.bound != "at_least" && factor.bound != "at_most")
    field["bound"].fail("must be exact, at_least or at_most");
  return factor;
}

MediaDataTerms readTerms(const ReportField& field) {
  return {.method = methodText(field["integrator"].text(), readSteps(field)),
          .withBuild = field["with_build"].flag(),
          .measure = field["measure"].text(),
          .faster = readFactor(field["faster_at_equal_error"]),
          .better = readFactor(field["less_error_at_equal_time"])};
}

MediaDataReference readReference(const ReportField& field) {
  return {.mean = field["mean"].number(),
          .bound = field["bound"].number(),
          .worstChange = field["worst_change"].number(),
          .atLimit = field["pixels_at_limit"].count(),
          .doublings = field["doublings"].count(),
          .rays = field["rays"].count(),
          .traceMs = field["trace_ms"].number(),
          .pictures = field["pictures"].pictures()};
}

}  // namespace

std::string MediaDataRow::name() const {
  return methodText(integrator, steps);
}

MediaData readMediaData(const ReportField& root) {
  const ReportField medium = root["medium"];
  MediaData data{.sigmaS = spectrumText(medium["sigma_s"]),
                 .sigmaA = spectrumText(medium["sigma_a"]),
                 .g = medium["g"].number(),
                 .reach = medium["reach"].number()};
  root["lights"].forItems([&](const ReportField& light) {
    data.lights.push_back(fmt::format("{}, {} cd", lightText(light), spectrumText(light["intensity"])));
  });
  if (root.has("reference")) data.reference = readReference(root["reference"]);
  if (root.has("worst_place")) {
    const ReportField place = root["worst_place"];
    data.worst = ReportPlace{place["x"].pixels(), place["y"].pixels(), place["size"].pixels(), 0};
  }
  if (root.has("frames")) {
    const ReportField frames = root["frames"];
    data.frames = MediaDataFrames{.count = frames["count"].count(),
                                  .moves = frames["moves"].text(),
                                  .offset = vectorText(frames["offset"].numbers()),
                                  .note = frames["note"].text()};
  }
  root["media"].forItems([&](const ReportField& row) { data.rows.push_back(readRow(row)); });
  root["equal_terms"].forItems([&](const ReportField& terms) { data.terms.push_back(readTerms(terms)); });
  return data;
}

}  // namespace gnomon
