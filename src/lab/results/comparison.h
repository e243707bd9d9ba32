#pragma once
// The results.json of gnomon compare, as a struct.

#include "lab/results/equal_error.h"
#include "lab/results/head.h"
#include "lab/results/light_facts.h"
#include "lab/results/media_row.h"
#include "lab/results/row.h"

namespace gnomon {

// What was exact for one map's light.
struct TruthSummary {
  std::string map;
  LightFacts light;
  size_t scored = 0, lit = 0, facingAway = 0, outsideCone = 0;
  double margin = 0.0;
  size_t marginFlipsHalf = 0, marginFlipsDouble = 0;
  std::optional<double> texel;
  std::optional<float> zNear, zFar;
  std::string fitNote;
  double receiversAndTraceMs = 0.0, fitMs = 0.0;

  static constexpr auto fields() {
    return std::tuple(
        field("map", &TruthSummary::map, {.says = "parameterization"}),
        field("light", &TruthSummary::light, {.says = "as this map treats it; below"}),
        field("scored", &TruthSummary::scored, {.unit = "pixels", .says = "that face the light within its cone"}),
        field("lit", &TruthSummary::lit, {.unit = "pixels", .says = "scored and lit"}),
        field("facing_away", &TruthSummary::facingAway, {.unit = "pixels", .says = "not scored"}),
        field("outside_cone", &TruthSummary::outsideCone, {.unit = "pixels", .says = "not scored"}),
        field("margin", &TruthSummary::margin, {.unit = "metres", .says = "the end margin (above)"}),
        field("margin_flips_half", &TruthSummary::marginFlipsHalf,
              {.unit = "pixels", .says = "that change when the margin is halved"}),
        field("margin_flips_double", &TruthSummary::marginFlipsDouble,
              {.unit = "pixels", .says = "that change when the margin is doubled"}),
        field("texel", &TruthSummary::texel,
              {.unit = "metres",
               .says = "median width of the map's texels on the surfaces that are scored; null for a volume"}),
        field("z_near", &TruthSummary::zNear, {.unit = "metres", .says = "of the fitted map's first slice"}),
        field("z_far", &TruthSummary::zFar, {.unit = "metres", .says = "of the fitted map's first slice"}),
        field("fit_note", &TruthSummary::fitNote,
              {.says = "why a warp was weakened or not applied; else empty", .absent = Absent::Earlier}),
        field("trace_ms", &TruthSummary::receiversAndTraceMs,
              {.unit = "ms", .says = "finding the receivers and tracing; wall clock", .absent = Absent::Earlier}),
        field("fit_ms", &TruthSummary::fitMs,
              {.unit = "ms", .says = "fitting the map; wall clock", .absent = Absent::Earlier}));
  }
};

// Of the texels of a map that looks around a point.
struct TexelSolidAngles {
  double smallest = 0.0, largest = 0.0;

  static constexpr auto fields() {
    return std::tuple(field("smallest", &TexelSolidAngles::smallest, {.unit = "steradians", .says = "of all texels"}),
                      field("largest", &TexelSolidAngles::largest, {.unit = "steradians", .says = "of all texels"}));
  }
};

struct MapSummary {
  std::string map, light;
  int width = 0, height = 0, layers = 0;
  std::optional<float> zNear, zFar;
  std::optional<TexelSolidAngles> solidAngles;
  Pictures pictures;
  std::vector<std::pair<std::string, Pictures>> filteredTruths;

  static constexpr auto fields() {
    return std::tuple(field("map", &MapSummary::map, {.says = "parameterization"}),
                      field("light", &MapSummary::light, {.says = "name of the light", .absent = Absent::Earlier}),
                      field("map_size", &MapSummary::width,
                            {.unit = "texels", .says = "width of a slice", .absent = Absent::Earlier}),
                      field("map_rows", &MapSummary::height,
                            {.unit = "texels", .says = "height of a slice", .absent = Absent::Earlier}),
                      field("layers", &MapSummary::layers,
                            {.says = "number of slices: faces, halves, cascades", .absent = Absent::Earlier}),
                      field("z_near", &MapSummary::zNear, {.unit = "metres", .says = "of the first slice"}),
                      field("z_far", &MapSummary::zFar, {.unit = "metres", .says = "of the first slice"}),
                      field("texel_solid_angle", &MapSummary::solidAngles,
                            {.says = "null unless the map covers directions around a point; below"}),
                      field("pictures", &MapSummary::pictures,
                            {.says = "paths relative to results.json; below", .absent = Absent::Earlier}),
                      field("truth_filtered", &MapSummary::filteredTruths,
                            {.says = "by filter, {`visibility`, `beauty`} of the truth through the same kernel",
                             .absent = Absent::Earlier}));
  }
};

// `light` and `truth` are those of the first map.
struct Comparison : ResultsHead {
  std::vector<std::string> notes;
  double timeNoise = 0.0;
  std::vector<TruthSummary> truths;
  std::vector<MapSummary> maps;
  std::vector<Row> rows;
  std::optional<EqualError> equalError;

  TruthSummary firstTruth() const { return truths.empty() ? TruthSummary{} : truths.front(); }
  LightFacts firstLight() const { return firstTruth().light; }
  std::vector<MediaRow> noMedia() const { return {}; }

  static constexpr auto fields() {
    return std::tuple_cat(
        ResultsHead::fields(),
        std::tuple(
            field("notes", &Comparison::notes,
                  {.says = "what a reader should know: lights that light nothing, a margin that is large for a texel, "
                           "biases without "
                           "the solids they need",
                   .absent = Absent::Earlier}),
            field("time_noise", &Comparison::timeNoise,
                  {.says = "times that differ by less, as a share, are not told apart: twice the standard error of the "
                           "rounds' median",
                   .absent = Absent::Earlier}),
            field("light", &Comparison::firstLight, {.says = "of the first map; below"}),
            field("truth", &Comparison::firstTruth, {.says = "of the first map; below"}),
            field("truths", &Comparison::truths, {.says = "one per map and light; below"}),
            field("maps", &Comparison::maps, {.says = "one per map and light; below", .absent = Absent::Earlier}),
            field("rows", &Comparison::rows, {.says = "one per method, map, light and filter; below"}),
            field("equal_error", &Comparison::equalError, {.says = "null without `--until-error`; below"}),
            field("media", &Comparison::noMedia, {.says = "empty (rows of `gnomon fog`)"})));
  }
};

}  // namespace gnomon
