#pragma once
// Rows of gnomon fog: one integrator on one map, compared with the ray-traced reference and with ray marching.

#include "lab/results/row.h"

namespace gnomon {

// "runs", "march 128".
std::string integratorText(const std::string& integrator, const std::optional<int>& steps);

struct MediaRow {
  std::string integrator;
  std::optional<int> steps;
  bool isBaseline = false;
  std::string map;
  Params params;
  std::optional<double> relRmse, relRmse99, flip, flicker;
  double mapMs = 0.0, tableMs = 0.0, integrateMs = 0.0;
  Pictures pictures;

  double buildMs() const { return mapMs + tableMs; }
  double totalMs() const { return buildMs() + integrateMs; }
  std::string name() const { return integratorText(integrator, steps); }

  static constexpr auto fields() {
    return std::tuple(
        field("integrator", &MediaRow::integrator, {.says = "its name, as `--integrators` has it"}),
        field("steps", &MediaRow::steps, {.says = "samples per view ray, or null"}),
        field("baseline", &MediaRow::isBaseline,
              {.says = "whether the other rows are compared with this one", .absent = Absent::Earlier}),
        field("map", &MediaRow::map, {.says = "`vsv`, `cube`, `paraboloid`"}),
        field("params", &MediaRow::params,
              {.says = "`map_size`, `lights`, `vsv_source`, `vsv_fit`, `cube_size`, `cull`"}),
        field("rel_rmse", &MediaRow::relRmse,
              {.says = "of the in-scattered light alone: RMSE over pixels and channels / the reference's mean; of a "
                       "black reference the RMSE itself, cd/m^2",
               .kind = NumberKind::Error,
               .title = "Error, all",
               .table = {"rel rmse", 9, 5},
               .hides = Hides::OnPage,
               .ranks = true,
               .least = 0}),
        field("rel_rmse_99", &MediaRow::relRmse99,
              {.says =
                   "the same without the 1 % of the pixels with the largest errors: beside a visible light, where the "
                   "integrand grows as 1/r^2, few pixels decide the other",
               .kind = NumberKind::Error,
               .title = "Error, 99 %",
               .table = {"rmse 99%", 9, 5},
               .hides = Hides::OnPage,
               .least = 0}),
        field("flip", &MediaRow::flip,
              {.says = "mean FLIP of the exposed pictures, surfaces and all",
               .title = "FLIP",
               .table = {"flip", 9, 5},
               .hides = Hides::OnPage,
               .least = 0}),
        field("flicker", &MediaRow::flicker,
              {.says = "of `--frames`, as docs/media.md defines it, or null",
               .kind = NumberKind::Error,
               .title = "Flicker",
               .table = {"flicker", 9, 5},
               .hides = Hides::Everywhere,
               .least = 0}),
        field("map_ms", &MediaRow::mapMs,
              {.unit = "ms",
               .says = "drawing the volume or map; median of `--repeats`, wall clock, all lights together",
               .kind = NumberKind::Milliseconds,
               .title = "Map ms",
               .table = {"map ms", 9, 2},
               .least = 0}),
        field("table_ms", &MediaRow::tableMs,
              {.unit = "ms",
               .says = "tabulating the running integral; likewise",
               .kind = NumberKind::Milliseconds,
               .title = "Table ms",
               .table = {"table ms", 9, 2},
               .least = 0}),
        field("build_ms", &MediaRow::buildMs,
              {.unit = "ms", .says = "`map_ms` + `table_ms`", .kind = NumberKind::Milliseconds}),
        field("integrate_ms", &MediaRow::integrateMs,
              {.unit = "ms",
               .says = "integrating; likewise",
               .kind = NumberKind::Milliseconds,
               .title = "Integral ms",
               .table = {"integrate ms", 13, 2},
               .least = 0}),
        field("all_ms", &MediaRow::totalMs,
              {.unit = "ms",
               .says = "of all of it",
               .kind = NumberKind::Milliseconds,
               .title = "All ms",
               .table = {"all ms", 9, 2},
               .inFile = false}),
        field("pictures", &MediaRow::pictures, {.says = "paths relative to results.json; below"}));
  }
};

// What a factor is where the baseline's curve does not reach.
enum class Bound {
  Exact,
  AtLeast,  // the baseline does not reach this error with the most steps tried; nor is it that fast with the fewest
  AtMost,   // the baseline is better or faster already with the fewest steps tried
};

struct Factor {
  double value = 0.0;
  Bound bound = Bound::Exact;

  static constexpr auto fields() {
    return std::tuple(field("factor", &Factor::value, {.says = "above 1, the row is better"}),
                      field("bound", &Factor::bound, {.says = "below"}));
  }
};

enum class ErrorMeasure { RelRmse, RelRmse99 };
const char* boundName(Bound bound);                  // exact, at_least, at_most
const char* errorMeasureName(ErrorMeasure measure);  // rel_rmse, rel_rmse_99

// A row against the baseline of the same run.
struct EqualTerms {
  std::string integrator;
  std::optional<int> steps;
  std::string against;
  bool withBuild = false;
  ErrorMeasure measure = ErrorMeasure::RelRmse;
  Factor faster, better;

  std::string method() const { return integratorText(integrator, steps); }

  static constexpr auto fields() {
    return std::tuple(
        field("integrator", &EqualTerms::integrator, {.says = "of the row"}),
        field("steps", &EqualTerms::steps, {.says = "of the row"}),
        field("against", &EqualTerms::against, {.says = "integrator of the baseline"}),
        field("with_build", &EqualTerms::withBuild, {.says = "whether maps, volumes and tables are counted"}),
        field("measure", &EqualTerms::measure, {.says = "`rel_rmse` or `rel_rmse_99`"}),
        field("faster_at_equal_error", &EqualTerms::faster, {.says = "the baseline's time over the row's"}),
        field("less_error_at_equal_time", &EqualTerms::better, {.says = "the baseline's error over the row's"}));
  }
};

// Of a row, by name, with or without builds; null where there are none.
const EqualTerms* findTerms(const std::vector<EqualTerms>& all, const std::string& method, bool withBuild,
                            ErrorMeasure measure);

}  // namespace gnomon
