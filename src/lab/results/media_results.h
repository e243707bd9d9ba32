#pragma once
// The results.json of gnomon fog, as a struct.

#include "lab/results/head.h"
#include "lab/results/light_facts.h"
#include "lab/results/media_row.h"

namespace gnomon {

struct DensityFacts {
  std::string grid;
  glm::vec3 lower{0.0f}, upper{0.0f};
  float voxelMetres = 0.0f;
  size_t voxels = 0;

  static constexpr auto fields() {
    return std::tuple(field("grid", &DensityFacts::grid, {.says = "name of the grid"}),
                      field("lower", &DensityFacts::lower, {.unit = "metres", .says = "corner of its bounding box"}),
                      field("upper", &DensityFacts::upper, {.unit = "metres", .says = "corner of its bounding box"}),
                      field("voxel_metres", &DensityFacts::voxelMetres, {.unit = "metres", .says = "size of a voxel"}),
                      field("voxels", &DensityFacts::voxels, {.says = "number of active voxels"}));
  }
};

struct MediumFacts {
  glm::vec3 sigmaS{0.0f}, sigmaA{0.0f};
  float g = 0.0f, reach = 0.0f;
  std::optional<DensityFacts> density;

  static constexpr auto fields() {
    return std::tuple(field("sigma_s", &MediumFacts::sigmaS, {.unit = "1/m", .says = "scattering, rgb, at density 1"}),
                      field("sigma_a", &MediumFacts::sigmaA, {.unit = "1/m", .says = "absorption, rgb, at density 1"}),
                      field("g", &MediumFacts::g, {.says = "anisotropy of the phase function"}),
                      field("reach", &MediumFacts::reach, {.unit = "metres", .says = "longest view ray"}),
                      field("density", &MediumFacts::density, {.says = "null if the medium is homogeneous; below"}));
  }
};

struct ReferenceFacts {
  double mean = 0.0, bound = 0.0, worstChange = 0.0;
  size_t atLimit = 0;
  int doublings = 0;
  uint64_t rays = 0;
  double traceMs = 0.0;
  bool fromCache = false;
  Pictures pictures;

  static constexpr auto fields() {
    return std::tuple(
        field("mean", &ReferenceFacts::mean, {.unit = "cd/m^2", .says = "over pixels and channels"}),
        field("bound", &ReferenceFacts::bound, {.says = "the convergence tolerance, as a fraction of the mean"}),
        field("worst_change", &ReferenceFacts::worstChange,
              {.says = "largest change of a pixel by its last doubling of samples, as a fraction of the mean"}),
        field("pixels_at_limit", &ReferenceFacts::atLimit,
              {.unit = "pixels", .says = "that reached the limit of doublings"}),
        field("doublings", &ReferenceFacts::doublings, {.says = "most doublings of any pixel"}),
        field("rays", &ReferenceFacts::rays, {.says = "rays traced"}),
        field("trace_ms", &ReferenceFacts::traceMs, {.unit = "ms", .says = "wall clock"}),
        field("from_cache", &ReferenceFacts::fromCache,
              {.says = "whether it was cached by an earlier run", .absent = Absent::Earlier}),
        field("pictures", &ReferenceFacts::pictures, {.says = "paths, as of a row"}));
  }
};

struct FramesFacts {
  int count = 0;
  std::string moves;
  glm::vec3 offset{0.0f};
  std::optional<glm::vec3> axis;
  std::optional<double> degrees;
  std::string note;
  Pictures pictures;

  static constexpr auto fields() {
    return std::tuple(
        field("count", &FramesFacts::count, {.says = "number of frames"}),
        field("moves", &FramesFacts::moves, {.says = "light, camera or density, or two of them with `and` between"}),
        field("offset", &FramesFacts::offset, {.unit = "metres", .says = "from the first frame to the last"}),
        field("axis", &FramesFacts::axis,
              {.says = "of the light's orbit about the scene's centre, a unit vector; else absent",
               .absent = Absent::LeftOut}),
        field(
            "degrees", &FramesFacts::degrees,
            {.unit = "degrees", .says = "of that orbit, from the first frame to the last", .absent = Absent::LeftOut}),
        field("note", &FramesFacts::note, {.says = "where the video is, or why there is none"}),
        field("pictures", &FramesFacts::pictures,
              {.says = "with `-o`: paths of some frames of the first row and of the reference, by `frame N of METHOD`",
               .absent = Absent::Earlier}));
  }
};

struct MediaResults : ResultsHead {
  std::vector<LightFacts> lights;
  MediumFacts medium;
  double exposure = 1.0;
  std::optional<ReferenceFacts> reference;
  std::optional<WorstPlace> worst;
  std::optional<FramesFacts> frames;
  std::vector<MediaRow> rows;
  std::vector<EqualTerms> equalTerms;

  std::vector<Row> noRows() const { return {}; }

  static constexpr auto fields() {
    return std::tuple_cat(
        ResultsHead::fields(),
        std::tuple(
            field("lights", &MediaResults::lights, {.says = "as `light` above"}),
            field("medium", &MediaResults::medium, {.says = "below"}),
            field("exposure", &MediaResults::exposure,
                  {.says = "factor from radiance to PNG", .absent = Absent::Earlier}),
            field("reference", &MediaResults::reference, {.says = "null without `--truth`; below"}),
            field("worst_place", &MediaResults::worst,
                  {.says =
                       "null, or the square where the first row's error is largest relative to the brightness there"}),
            field("frames", &MediaResults::frames, {.says = "null, or the motion of `--frames`; below"}),
            field("rows", &MediaResults::noRows, {.says = "empty (of `gnomon compare`)"}),
            field("maps", &MediaResults::noRows, {.says = "empty (of `gnomon compare`)"}),
            field("truths", &MediaResults::noRows, {.says = "empty (of `gnomon compare`)"}),
            field("media", &MediaResults::rows, {.says = "one per integrator and number of steps; below"}),
            field("equal_terms", &MediaResults::equalTerms,
                  {.says = "how each other row compares with the baseline; below"})));
  }
};

}  // namespace gnomon
