#pragma once
// The exact shadow volume: the first hit of every column's ray, in double precision; and by how much, and why, another
// volume's boundaries differ from it. Frame: L of the volume (LightFrame), metres.

#include "truth/tracer.h"
#include "vsv/check/dense_volume.h"

#include "shared/light_frame.glsl"

#include <array>
#include <functional>

namespace gnomon {

// The light ray through the centre of a column, from the light.
RayD columnRayW(const glsl::LightFrame& frame, const glsl::EpipolarGrid& grid, int theta, int phi);

struct ExactVolume {
  ColumnBoundaries boundaries;
  std::vector<double> alphaOccluder;  // radians, by columnIndex; infinity where the ray hits nothing
  std::vector<double> distance;       // metres from the light to what is hit; infinity
};
// All cores.
ExactVolume traceColumns(const Tracer& tracer, const glsl::LightFrame& frame, const glsl::EpipolarGrid& grid);

// Why a boundary is not the exact one.
enum class BoundaryCause {
  Rounding,    // one voxel off, and the exact occluder lies within `rounding` of the centre that decides
  Outside,     // what the column's ray hits lies outside the depths that the source covers
  Silhouette,  // between the source's ray and the column's the surface is in two pieces (truth/continuity.h)
  Resolution,  // the surface is continuous there: the source's ray meets it nearer or farther
};
inline constexpr int kBoundaryCauseCount = 4;
const char* boundaryCauseName(BoundaryCause cause);  // "rounding", ...

// How a volume's source sees a column; asked for wrong columns only, from many threads at once.
struct ColumnSource {
  // The ray whose occluder the source gave the column. A source that decides by the column's own ray gives
  // none; silhouettes are then looked for within the angle that float rays stray by.
  std::function<RayD(int theta, int phi)> rayW;
  std::function<bool(const glm::dvec3& positionW)> covers;  // none: everything
  // By how much alpha_occ may be off where all went well, radians.
  std::function<double(double alphaOccluder, int phi)> rounding;
};

// Columns by how many voxels their boundary is off: 0, 1, 2-3, 4-7, 8-15, ...
using BoundaryHistogram = std::vector<uint64_t>;
// The lowest distance of a histogram's bucket.
int bucketStart(size_t bucket);

struct BoundaryErrors {
  uint64_t columns = 0;
  BoundaryHistogram histogram;                                 // of all
  std::array<BoundaryHistogram, kBoundaryCauseCount> byCause;  // of those that are off
  uint64_t tooDark = 0;                                        // voxels occluded that exactly are lit
  uint64_t tooLight = 0;                                       // and the other way round
};
// All cores. `margin`: endMargin of the truth, metres.
BoundaryErrors compareBoundaries(const Tracer& tracer, const glsl::LightFrame& frame, const ExactVolume& exact,
                                 const ColumnBoundaries& measured, const ColumnSource& source, double margin);

}  // namespace gnomon
