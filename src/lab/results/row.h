#pragma once
// A row of a comparison: one bias on one map with one filter, compared with the exact shadow.

#include "lab/results/schema.h"

#include <cstdint>
#include <variant>

namespace gnomon {

// How good a tuned value is where it was not tuned.
struct Transfer {
  double biasError = 0.0, bestBiasError = 0.0;
  std::optional<double> rmse, bestRmse;
  float bestValue = 0.0f;

  static constexpr auto fields() {
    return std::tuple(
        field("bias_error", &Transfer::biasError, {.says = "there, with the value tuned here"}),
        field("best_bias_error", &Transfer::bestBiasError, {.says = "there, with the value tuned there"}),
        field("rmse", &Transfer::rmse,
              {.says = "likewise, through the row's filter; absent without one", .absent = Absent::LeftOut}),
        field("best_rmse", &Transfer::bestRmse, {.says = "likewise", .absent = Absent::LeftOut}),
        field("best_value", &Transfer::bestValue, {.says = "the value tuned there"}));
  }
};

struct CameraTransfer : Transfer {
  std::string camera;

  static constexpr auto fields() {
    return std::tuple_cat(std::tuple(field("camera", &CameraTransfer::camera, {.says = "its name"})),
                          Transfer::fields());
  }
};

struct MapSizeTransfer : Transfer {
  int mapSize = 0;

  static constexpr auto fields() {
    return std::tuple_cat(
        std::tuple(field("map_size", &MapSizeTransfer::mapSize, {.unit = "texels", .says = "width of a slice"})),
        Transfer::fields());
  }
};

struct Tuning {
  std::string knob;
  float value = 0.0f;
  std::string unit, atEnd;
  int evaluations = 0;
  std::optional<CameraTransfer> otherCamera;
  std::optional<MapSizeTransfer> otherMapSize;

  static constexpr auto fields() {
    return std::tuple(
        field("knob", &Tuning::knob, {.says = "the parameter that was tuned: the bias's first"}),
        field("value", &Tuning::value,
              {.says = "with the least acne and leak here; through a filter, with the least RMSE"}),
        field("unit", &Tuning::unit, {.says = "of `value`", .absent = Absent::Earlier}),
        field("evaluations", &Tuning::evaluations, {.says = "number of values tried"}),
        field("at_end", &Tuning::atEnd,
              {.says = "`lower` or `upper` where the value lies at that end of those that were tried, so that a better "
                       "one may "
                       "lie beyond; else empty",
               .absent = Absent::Earlier}),
        field("other_camera", &Tuning::otherCamera, {.says = "how well the value works from a second camera; or null"}),
        field("other_map_size", &Tuning::otherMapSize,
              {.says = "how well it works on a map of half the size; or null"}));
  }
};

// How wrong a method is where nobody chose it.
struct ErrorElsewhere {
  double biasError = 0.0, allWrong = 0.0;
  std::optional<double> rmse;

  static constexpr auto fields() {
    return std::tuple(
        field("bias_error", &ErrorElsewhere::biasError, {.says = "there"}),
        field("all_wrong", &ErrorElsewhere::allWrong, {.says = "there"}),
        field("rmse", &ErrorElsewhere::rmse,
              {.says = "there, through the row's filter; absent without one", .absent = Absent::LeftOut}));
  }
};

struct CameraError : ErrorElsewhere {
  std::string camera;

  static constexpr auto fields() {
    return std::tuple_cat(std::tuple(field("camera", &CameraError::camera, {.says = "its name"})),
                          ErrorElsewhere::fields());
  }
};

struct MapSizeError : ErrorElsewhere {
  int mapSize = 0;

  static constexpr auto fields() {
    return std::tuple_cat(
        std::tuple(field("map_size", &MapSizeError::mapSize, {.unit = "texels", .says = "width of a slice"})),
        ErrorElsewhere::fields());
  }
};

struct Elsewhere {
  std::optional<CameraError> otherCamera;
  std::optional<MapSizeError> otherMapSize;

  static constexpr auto fields() {
    return std::tuple(
        field("other_camera", &Elsewhere::otherCamera,
              {.says = "seen from a second camera; or null, where that sees nothing that faces the light"}),
        field("other_map_size", &Elsewhere::otherMapSize, {.says = "on a map of half the size"}));
  }
};

// How the walks of `witness` went, over all scored pixels (docs/witness.md).
struct Walks {
  size_t count = 0;
  double meanSteps = 0.0;
  int longest = 0;
  double receiver = 0.0, witness = 0.0, behind = 0.0, hole = 0.0, open = 0.0, fold = 0.0;
  size_t aborted = 0;

  static constexpr auto fields() {
    const char* share = "share of walks";
    return std::tuple(
        field("count", &Walks::count, {.says = "number of walks: one a texel that was asked and holds a triangle"}),
        field("mean_steps", &Walks::meanSteps, {.says = "triangles entered a walk"}),
        field("longest", &Walks::longest, {.unit = "steps", .says = "of all"}),
        field("receiver", &Walks::receiver, {.unit = share, .says = "that came to the receiver's own triangle"}),
        field("witness", &Walks::witness, {.unit = share, .says = "whose surface shadows the receiver"}),
        field("behind", &Walks::behind, {.unit = share, .says = "whose surface passes at or behind it"}),
        field("hole", &Walks::hole, {.unit = share, .says = "whose surface has a hole of its alpha mask there"}),
        field("open", &Walks::open, {.unit = share, .says = "that came to an open or non-manifold edge"}),
        field("fold", &Walks::fold, {.unit = share, .says = "that came to an edge where the surface turns back"}),
        field("aborted", &Walks::aborted,
              {.says = "number of walks given up after 128 steps, where `two-plane` decided"}));
  }
};

// A parameter of a bias (a number with a point), or what else sets the map and the method up.
struct Param {
  std::string name;
  std::variant<std::string, int64_t, double> value;

  bool operator==(const Param&) const = default;
};
using Params = std::vector<Param>;

std::string paramText(const Param& param);                             // "0.0125", "solids"
std::string paramText(const Params& params, const std::string& name);  // empty where there is none

// A filter's parameters stand among a row's beside the bias's: "filter_width".
std::string filterParamName(const std::string& knob);
bool isFilterParam(const std::string& name);

// Counts are of the unfiltered map, and add up to `scored`.
struct Row {
  std::string map, light;
  bool isSum = false;
  int mapSide = 0, layers = 0;
  size_t mapTexels = 0, mapBytes = 0;
  std::string mapDimensions;
  std::string bias;
  Params params;
  NamedTexts units;
  std::string filter = "none";
  size_t scored = 0, agree = 0, acne = 0, leak = 0, edgeShadow = 0, edgeLight = 0, uncovered = 0;
  size_t grazing = 0, edgeOn = 0;
  std::optional<size_t> unseenOccluder, unseenSurface;
  double rmse = 0.0;
  std::optional<double> flip;
  double buildMs = 0.0, shadeMs = 0.0, frameMs = 0.0;
  bool isGiven = false;
  std::optional<Tuning> tuning;
  std::optional<Elsewhere> elsewhere;
  std::optional<WorstPlace> worstAcne, worstLeak;
  std::optional<Walks> walks;
  std::string command;
  Pictures pictures;

  bool isTuned() const { return tuning.has_value(); }
  size_t edge() const { return edgeShadow + edgeLight; }
  size_t wrong() const { return scored - agree; }
  double biasError() const { return shareOf(acne + leak); }
  double allWrong() const { return shareOf(wrong()); }
  bool isFiltered() const { return filter != "none"; }
  double shareOf(size_t pixels) const;  // of the scored ones

  bool isKnob(const Param& param) const;
  std::string unitOf(const std::string& knob) const;  // empty where it has none

  // Of the scored pixels, those with one label.
  static constexpr auto labelCount(const char* name, size_t Row::*count, const char* title, TableColumn table,
                                   Hides hides = Hides::Never) {
    return field(name, count,
                 {.unit = "pixels",
                  .says = "with this label",
                  .kind = NumberKind::Count,
                  .title = title,
                  .table = table,
                  .hides = hides,
                  .metric = true});
  }

  static constexpr auto fields() {
    return std::tuple(
        field("map", &Row::map, {.says = "parameterization"}),
        field("light", &Row::light, {.says = "name of the light; `all` in a sum", .absent = Absent::Earlier}),
        field("sum", &Row::isSum,
              {.says = "true: of this method over all lights (`--light all`); counts and times are added",
               .absent = Absent::Earlier}),
        field("map_size", &Row::mapSide, {.unit = "texels", .says = "width of a slice"}),
        field("layers", &Row::layers, {.says = "number of slices: faces, halves, cascades"}),
        field("map_texels", &Row::mapTexels, {.says = "in all slices"}),
        field("map_bytes", &Row::mapBytes,
              {.unit = "bytes", .says = "of the channels that its bias reads", .absent = Absent::Earlier}),
        field("map_dimensions", &Row::mapDimensions,
              {.says = "`map_size`, or a volume's voxels: alpha x theta x phi", .absent = Absent::Earlier}),
        field("bias", &Row::bias, {.says = "its name"}),
        field("params", &Row::params, {.says = "map and bias parameters; below", .absent = Absent::Earlier}),
        field("units", &Row::units,
              {.says = "units of the bias parameters among `params`, by name", .absent = Absent::Earlier}),
        field("filter", &Row::filter, {.says = "`none`, `bilinear`, `jitter4x4`", .absent = Absent::Earlier}),
        field("tuned", &Row::isTuned, {.says = "whether its parameters were searched (`--tune`), for this filter"}),
        field("given", &Row::isGiven,
              {.says = "whether the command line sets one of its bias's parameters", .absent = Absent::Earlier}),
        field("scored", &Row::scored,
              {.unit = "pixels", .says = "that face the light within its cone", .kind = NumberKind::Count}),
        labelCount("agree", &Row::agree, "", {"agree", 9, 0, kWideOnly}),
        labelCount("acne", &Row::acne, "Acne", {"acne", 8}), labelCount("leak", &Row::leak, "Leak", {"leak", 8}),
        labelCount("edge_shadow", &Row::edgeShadow, "Edge, shadow", {"edge_sh", 8, 0, kWideOnly}),
        labelCount("edge_light", &Row::edgeLight, "Edge, light", {"edge_li", 8, 0, kWideOnly}),
        field("edge", &Row::edge,
              {.unit = "pixels",
               .says = "both",
               .kind = NumberKind::Count,
               .table = {"edge", 8, 0, 3},
               .metric = true,
               .inFile = false}),
        labelCount("uncovered", &Row::uncovered, "Uncovered", {"uncovered", 9, 0, 4}, Hides::Everywhere),
        field("unseen_occluder", &Row::unseenOccluder,
              {.unit = "pixels",
               .says = "of leak and edge_light: no texel near names a triangle that shadows the pixel; of biases that "
                       "read ids, else left out",
               .absent = Absent::LeftOut,
               .kind = NumberKind::Count,
               .table = {"unseen", 7, 0, kWideOnly},
               .hides = Hides::Everywhere}),
        field("unseen_surface", &Row::unseenSurface,
              {.unit = "pixels",
               .says = "of these: none names a triangle of the surface that shadows it; likewise",
               .absent = Absent::LeftOut,
               .kind = NumberKind::Count,
               .table = {"uns surf", 8, 0, kWideOnly},
               .hides = Hides::Everywhere}),
        field("grazing", &Row::grazing,
              {.unit = "pixels",
               .says = "whose texel ray does not meet the receiver's plane between near and far; the receiver's own "
                       "depth is used "
                       "instead",
               .absent = Absent::Earlier,
               .kind = NumberKind::Count,
               .metric = true}),
        field("edge_on", &Row::edgeOn,
              {.unit = "pixels",
               .says = "that face away in the shader's floats but not in double precision: edge-on within rounding, "
                       "counted as "
                       "agreeing",
               .absent = Absent::Earlier,
               .kind = NumberKind::Count,
               .metric = true}),
        field("wrong", &Row::wrong,
              {.unit = "pixels", .says = "all but `agree`", .kind = NumberKind::Count, .metric = true}),
        field("bias_error", &Row::biasError,
              {.says = "(acne + leak) / scored",
               .kind = NumberKind::Share,
               .table = {"bias error", 10, 4},
               .ranks = true,
               .metric = true}),
        field("all_wrong", &Row::allWrong,
              {.says = "`wrong` / scored: edges too, which no bias that compares depths can mend",
               .kind = NumberKind::Share,
               .table = {"all wrong", 9, 4},
               .metric = true}),
        field("rmse", &Row::rmse,
              {.says = "of the visibility against the truth through the same filter; uncovered pixels count as lit",
               .title = "RMSE",
               .table = {"rmse", 7, 4, 2},
               .metric = true}),
        field("flip", &Row::flip,
              {.says = "mean FLIP of the shaded picture; null where no filter is asked for",
               .title = "FLIP",
               .table = {"flip", 7, 4, 4},
               .hides = Hides::Everywhere,
               .metric = true}),
        field("build_ms", &Row::buildMs,
              {.unit = "ms",
               .says = "drawing the map; median of `--repeats`, wall clock",
               .kind = NumberKind::Milliseconds,
               .title = "Build ms",
               .table = {"build ms", 9, 2, kWideOnly},
               .metric = true}),
        field("shade_ms", &Row::shadeMs,
              {.unit = "ms",
               .says = "visibility pass; likewise",
               .kind = NumberKind::Milliseconds,
               .title = "Shade ms",
               .table = {"shade ms", 9, 2, kWideOnly},
               .metric = true}),
        field("frame_ms", &Row::frameMs,
              {.unit = "ms",
               .says = "`gbuffer_ms` + `build_ms` + `shade_ms`",
               .kind = NumberKind::Milliseconds,
               .title = "Frame ms",
               .table = {"frame ms", 9, 2, 1},
               .metric = true}),
        field("tuning", &Row::tuning, {.says = "of a tuned row, else null; below"}),
        field("elsewhere", &Row::elsewhere, {.says = "of the row that is recommended, else null; below"}),
        field("worst_acne", &Row::worstAcne, {.says = "the square of the picture with the most acne, or null; below"}),
        field("worst_leak", &Row::worstLeak, {.says = "likewise of leak"}),
        field("walks", &Row::walks, {.says = "of `witness`, else left out; below", .absent = Absent::LeftOut}),
        field("command", &Row::command,
              {.says = "the command line that makes this row again", .absent = Absent::Earlier}),
        field("pictures", &Row::pictures,
              {.says = "paths relative to results.json; below", .absent = Absent::Earlier}));
  }
};

// What ranks the rows of a comparison: the bias error; where a filter is asked for, the RMSE of each row against the
// truth through the same filter.
enum class Ranking { BiasError, Rmse };
Ranking rankingOf(const std::vector<Row>& rows);
double rankingError(Ranking ranking, const Row& row);

// Rows by what ranks them, then by all wrong pixels, then as they ran.
std::vector<Row> ranked(std::vector<Row> rows);

// The first of the ranked rows whose parameters were not searched for this very picture, and the first of those whose
// were. Of several lights their sums. Null where there is none.
struct BestRows {
  const Row* untuned = nullptr;
  const Row* tuned = nullptr;
};
BestRows bestOf(const std::vector<Row>& rankedRows);

}  // namespace gnomon
