#include "truth/media_reference.h"

#include "base/check.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "truth/scattering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include <glm/gtx/component_wise.hpp>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

constexpr int kTileSide = 4;  // pixels that are refined together, and whose edges fill packets

// The last sample of visibility stands this share of the ray's phi before its end: at the surface itself the
// surface would have to be told from its own blockers. A wrong answer costs no more than this share.
constexpr double kShortOfEnd = 0x1p-20;
// An edge may move, and each piece's quadrature err, by this share of the bound.
constexpr double kShareOfBound = 0.02;
constexpr int kMostBisections = 44;  // from a 128th of the ray to its last bits

// The picture's mean, which the bound is a share of, is estimated first from this many samples a ray; it is
// good to some percent, and the bound is kept from the lower end of that.
constexpr int kSamplesForMean = 16;
constexpr double kEdgeForMean = 0x1p-12;  // of the ray's phi
constexpr double kMeanReserve = 0.9;

// Steps along rays through a density, in voxels, and cells of phi, before the first halving. Trilinear values
// bend at every voxel, so that the second halving is the first to say much.
constexpr double kFirstStepVoxels = 2.0;
constexpr int kFirstCells = 32;
constexpr int kMostHalvings = 5;

constexpr int kQuietDoublings = 2;

// A hash by Mark Jarzynski and Marc Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg).
uint32_t hashWord(uint32_t word) {
  const uint32_t state = word * 747796405u + 2891336453u;
  const uint32_t mixed = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (mixed >> 22u) ^ mixed;
}

// In [0, 1).
double jitter(uint32_t pixel, size_t strata, size_t stratum) {
  return hashWord(hashWord(hashWord(pixel) + static_cast<uint32_t>(strata)) + static_cast<uint32_t>(stratum)) * 0x1p-32;
}

struct VisibilitySample {
  double phi = 0.0;
  bool lit = false;
};

// One view ray towards one light, and what is known of the light's visibility along it.
struct SampledRay {
  uint32_t pixel = 0;
  ScatteringRay ray;
  std::vector<double> strata;             // the sample of each, as a share of the ray's phi
  std::vector<VisibilitySample> samples;  // by phi
  std::optional<DensityProfile> profile;  // of a density
};

// Everything but the pixels' own rays.
struct Task {
  const Tracer& tracer;
  std::span<const MediaLight> lights;
  const glsl::CameraView& camera;
  std::span<const double> ends;
  const MediumModel& medium;
  double tolerance = std::numeric_limits<double>::infinity();  // cd/m^2, of an edge and of a piece's quadrature
};

class Tile {
 public:
  Tile(const Task& task, int tileX, int tileY) : task_(task) {
    const int width = task.camera.width;
    for (int y = tileY; y < std::min(tileY + kTileSide, task.camera.height); ++y)
      for (int x = tileX; x < std::min(tileX + kTileSide, width); ++x)
        pixels_.push_back(static_cast<uint32_t>(y * width + x));
    for (const MediaLight& light : task.lights) {
      for (const uint32_t pixel : pixels_) {
        const RayD view = pixelRay(task.camera, static_cast<int>(pixel) % width, static_cast<int>(pixel) / width);
        ScatteringRay ray = scatteringRay(view, task.ends[pixel], light, task.medium);
        if (ray.sFrom < ray.sTo) rays_.push_back({.pixel = pixel, .ray = ray});
      }
    }
  }

  std::span<const uint32_t> pixels() const { return pixels_; }
  uint64_t traced() const { return traced_; }

  // One sample in each of `count` strata and at the ends.
  void begin(int count) {
    for (SampledRay& ray : rays_) {
      std::vector<double> fresh = {0.0};
      for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
        ray.strata.push_back((static_cast<double>(i) + jitter(ray.pixel, static_cast<size_t>(count), i)) / count);
        fresh.push_back(std::min(ray.strata.back(), 1.0 - kShortOfEnd));
      }
      fresh.push_back(1.0 - kShortOfEnd);
      sample(ray, fresh);
      sampleBetween(ray, coneCrossings(ray.ray));
    }
    bisect();
  }

  // Halves each stratum; the half without a sample gets one.
  void refine() {
    for (SampledRay& ray : rays_) {
      const size_t count = 2 * ray.strata.size();
      std::vector<double> halves(count), fresh;
      for (size_t i = 0; i < ray.strata.size(); ++i) {
        const size_t old =
            ray.strata[i] * static_cast<double>(count) < static_cast<double>(2 * i + 1) ? 2 * i : 2 * i + 1;
        const size_t other = old ^ 1;
        halves[old] = ray.strata[i];
        halves[other] = (static_cast<double>(other) + jitter(ray.pixel, count, other)) / static_cast<double>(count);
        fresh.push_back(std::min(halves[other], 1.0 - kShortOfEnd));
      }
      ray.strata = std::move(halves);
      sample(ray, fresh);
    }
    bisect();
  }

  // The steps through a density, halved that often.
  void setSteps(int halvings) {
    if (task_.medium.density == nullptr) return;
    const double step = kFirstStepVoxels * task_.medium.density->voxelMetres() / static_cast<double>(1 << halvings);
    for (SampledRay& ray : rays_) ray.profile.emplace(ray.ray, task_.medium, step, kFirstCells << halvings);
  }

  // cd/m^2, one a pixel.
  std::vector<glm::dvec3> radiance() {
    std::vector<glm::dvec3> sums(pixels_.size(), glm::dvec3(0.0));
    for (SampledRay& ray : rays_) {
      const auto pixel = std::ranges::find(pixels_, ray.pixel) - pixels_.begin();
      sums[static_cast<size_t>(pixel)] += scatter(ray);
    }
    return sums;
  }

 private:
  void look(const MediaLight& light, std::span<const glm::dvec3> pointsW, std::span<VisibilitySample> samples) {
    blocked_.assign(pointsW.size(), 1);
    if (light.cosCone > -1.0) {
      lookWithinCone(light, pointsW);
    } else {
      task_.tracer.blockPoints(light.positionW, pointsW, blocked_);
      traced_ += pointsW.size();
    }
    for (size_t i = 0; i < pointsW.size(); ++i) samples[i].lit = blocked_[i] == 0;
  }

  void lookWithinCone(const MediaLight& light, std::span<const glm::dvec3> pointsW) {
    std::vector<glm::dvec3> within;
    std::vector<size_t> of;
    for (size_t i = 0; i < pointsW.size(); ++i) {
      const glm::dvec3 towards = pointsW[i] - light.positionW;
      if (glm::dot(towards, light.axisW) < light.cosCone * glm::length(towards)) continue;
      within.push_back(pointsW[i]);
      of.push_back(i);
    }
    std::vector<uint8_t> blocked(within.size());
    task_.tracer.blockPoints(light.positionW, within, blocked);
    for (size_t i = 0; i < of.size(); ++i) blocked_[of[i]] = blocked[i];
    traced_ += within.size();
  }

  // `shares` of the ray's phi, ascending.
  void sample(SampledRay& ray, std::span<const double> shares) {
    std::vector<VisibilitySample> fresh;
    std::vector<glm::dvec3> pointsW;
    fresh.reserve(shares.size());
    pointsW.reserve(shares.size());
    for (const double share : shares) {
      fresh.push_back({.phi = ray.ray.phiFrom + (ray.ray.phiTo - ray.ray.phiFrom) * share});
      pointsW.push_back(ray.ray.pointAt(fresh.back().phi));
    }
    look(ray.ray.light, pointsW, fresh);
    addSamples(ray, fresh);
  }

  // `fresh`: by phi.
  static void addSamples(SampledRay& ray, std::span<const VisibilitySample> fresh) {
    const auto old = static_cast<std::ptrdiff_t>(ray.samples.size());
    ray.samples.insert(ray.samples.end(), fresh.begin(), fresh.end());
    std::ranges::inplace_merge(ray.samples, ray.samples.begin() + old, {}, &VisibilitySample::phi);
  }

  // One within each stretch that the crossings leave, however short.
  void sampleBetween(SampledRay& ray, std::span<const double> crossings) {
    const double span = ray.ray.phiTo - ray.ray.phiFrom;
    std::vector<double> shares;
    for (size_t i = 0; i < crossings.size(); ++i) {
      const double next = i + 1 < crossings.size() ? crossings[i + 1] : ray.ray.phiTo;
      const double before = i > 0 ? crossings[i - 1] : ray.ray.phiFrom;
      shares.push_back((0.5 * (crossings[i] + next) - ray.ray.phiFrom) / span);
      shares.push_back((0.5 * (before + crossings[i]) - ray.ray.phiFrom) / span);
    }
    std::ranges::sort(shares);
    if (!shares.empty()) sample(ray, shares);
  }

  // Two neighbouring samples of one ray that differ.
  struct Edge {
    SampledRay* of = nullptr;
    VisibilitySample before, after;
    double enough = 0.0;  // radians of phi between them
    bool open() const { return after.phi - before.phi > enough; }
  };

  std::vector<Edge> findEdges() {
    std::vector<Edge> edges;
    for (SampledRay& ray : rays_) {
      const double enough = std::isfinite(task_.tolerance) ? task_.tolerance / largestShare(ray.ray, task_.medium)
                                                           : kEdgeForMean * (ray.ray.phiTo - ray.ray.phiFrom);
      for (size_t i = 0; i + 1 < ray.samples.size(); ++i) {
        const Edge edge{&ray, ray.samples[i], ray.samples[i + 1], enough};
        if (edge.before.lit != edge.after.lit && edge.open()) edges.push_back(edge);
      }
    }
    return edges;
  }

  // Puts two samples around each edge, as near to each other as the tolerance asks.
  void bisect() {
    std::vector<Edge> edges = findEdges();
    for (int round = 0; round < kMostBisections; ++round) {
      // Lights in turn: a packet's rays start at one of them.
      for (size_t from = 0; from < edges.size();) {
        const MediaLight& light = edges[from].of->ray.light;
        std::vector<Edge*> open;
        size_t i = from;
        for (; i < edges.size() && edges[i].of->ray.light.positionW == light.positionW; ++i)
          if (edges[i].open()) open.push_back(&edges[i]);
        from = i;
        halve(light, open);
      }
    }
    for (size_t from = 0; from < edges.size();) {  // ray after ray
      std::vector<VisibilitySample> fresh;
      size_t i = from;
      for (; i < edges.size() && edges[i].of == edges[from].of; ++i)
        fresh.insert(fresh.end(), {edges[i].before, edges[i].after});
      addSamples(*edges[from].of, fresh);
      from = i;
    }
  }

  void halve(const MediaLight& light, std::span<Edge* const> edges) {
    std::vector<glm::dvec3> pointsW;
    std::vector<VisibilitySample> middle;
    for (const Edge* edge : edges) {
      middle.push_back({.phi = 0.5 * (edge->before.phi + edge->after.phi)});
      pointsW.push_back(edge->of->ray.pointAt(middle.back().phi));
    }
    look(light, pointsW, middle);
    for (size_t i = 0; i < edges.size(); ++i)
      (middle[i].lit == edges[i]->before.lit ? edges[i]->before : edges[i]->after) = middle[i];
  }

  // Between two samples that agree all is as they are; between two that differ the edge is half way.
  static std::vector<LitPiece> litPieces(const SampledRay& ray) {
    std::vector<LitPiece> pieces;
    double from = ray.ray.phiFrom;
    for (size_t i = 0; i < ray.samples.size(); ++i) {
      const bool last = i + 1 == ray.samples.size();
      if (!last && ray.samples[i].lit == ray.samples[i + 1].lit) continue;
      const double to = last ? ray.ray.phiTo : 0.5 * (ray.samples[i].phi + ray.samples[i + 1].phi);
      if (ray.samples[i].lit && from < to) pieces.push_back({from, to});
      from = to;
    }
    return pieces;
  }

  glm::dvec3 scatter(SampledRay& ray) const {
    const std::vector<LitPiece> pieces = litPieces(ray);
    return ray.profile ? ray.profile->scatter(ray.ray, task_.medium, pieces)
                       : scatterHomogeneous(ray.ray, pieces, task_.medium, task_.tolerance);
  }

  const Task& task_;
  std::vector<uint32_t> pixels_;
  std::vector<SampledRay> rays_;  // light after light
  std::vector<uint8_t> blocked_;
  uint64_t traced_ = 0;
};

std::vector<double> changesOf(std::span<const glm::dvec3> before, std::span<const glm::dvec3> after) {
  std::vector<double> changes(before.size());
  for (size_t i = 0; i < changes.size(); ++i) changes[i] = glm::compMax(glm::abs(after[i] - before[i]));
  return changes;
}

// Refines one tile to the bound (cd/m^2), and takes its pixels and its share of the summary: first the steps
// through a density, with the first samples of visibility, then visibility.
void refineTile(Tile& tile, bool hasDensity, double bound, const MediaReferenceOptions& options,
                std::vector<glm::dvec3>& radiance, MediaReference& summary) {
  tile.begin(options.firstSamples);
  tile.setSteps(0);
  std::vector<glm::dvec3> values = tile.radiance();
  std::vector<double> changes(values.size(), 0.0), stepChanges(values.size(), 0.0);
  for (int halvings = 1; hasDensity && halvings <= kMostHalvings; ++halvings) {
    tile.setSteps(halvings);
    const std::vector<glm::dvec3> next = tile.radiance();
    stepChanges = changesOf(values, next);
    values = next;
    if (halvings > 1 && *std::ranges::max_element(stepChanges) <= bound) break;
  }
  int doublings = 0;
  for (int quiet = 0; quiet < kQuietDoublings && doublings < options.mostDoublings; ++doublings) {
    tile.refine();
    const std::vector<glm::dvec3> next = tile.radiance();
    changes = changesOf(values, next);
    values = next;
    quiet = *std::ranges::max_element(changes) > bound ? 0 : quiet + 1;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const double change = std::max(changes[i], stepChanges[i]);
    radiance[tile.pixels()[i]] = values[i];
    summary.worstChange = std::max(summary.worstChange, change);
    summary.atLimit += change > bound ? 1 : 0;
  }
  summary.doublings = std::max(summary.doublings, doublings);
  summary.rays += tile.traced();
}

double meanOf(const std::vector<glm::dvec3>& radiance) {
  double sum = 0.0;
  for (const glm::dvec3& value : radiance) sum += value.x + value.y + value.z;
  return sum / (3.0 * static_cast<double>(radiance.size()));
}

// Rows of tiles one after another, their tiles on all cores.
template <typename Work>
void forTiles(const glsl::CameraView& camera, const char* what, const Work& work) {
  const int rows = (camera.height + kTileSide - 1) / kTileSide, columns = (camera.width + kTileSide - 1) / kTileSide;
  Progress progress("media reference", rows);
  for (int row = 0; row < rows; ++row) {
    throwIfInterrupted();
    progress.step(what);
    tbb::parallel_for(0, columns, [&](int column) {
      if (!isInterrupted()) work(column * kTileSide, row * kTileSide);
    });
  }
  throwIfInterrupted();
}

}  // namespace

std::vector<double> viewRayEnds(const glsl::CameraView& camera, const Receivers& receivers, double reach) {
  std::vector<double> ends(receivers.states.size(), reach);
  for (size_t i = 0; i < ends.size(); ++i)
    if (receivers.states[i] != PixelState::Empty)
      ends[i] = std::min(reach, glm::length(receivers.samples[i].positionW - glm::dvec3(camera.eyeW)));
  return ends;
}

MediaReference computeMediaReference(const Tracer& tracer, std::span<const MediaLight> lights,
                                     const glsl::CameraView& camera, std::span<const double> ends,
                                     const MediumModel& medium, const MediaReferenceOptions& options) {
  const size_t count = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  GNOMON_CHECK_EQ(ends.size(), count);
  GNOMON_CHECK_LE(kQuietDoublings, options.mostDoublings);
  const auto begin = std::chrono::steady_clock::now();
  MediaReference reference{.bound = options.bound};
  std::vector<glm::dvec3> radiance(count);
  Task task{tracer, lights, camera, ends, medium};
  forTiles(camera, "its mean", [&](int x, int y) {
    Tile tile(task, x, y);
    tile.begin(kSamplesForMean);
    tile.setSteps(0);
    const std::vector<glm::dvec3> values = tile.radiance();
    for (size_t i = 0; i < values.size(); ++i) radiance[tile.pixels()[i]] = values[i];
  });
  if (const double mean = kMeanReserve * meanOf(radiance); mean > 0.0) {
    std::mutex merging;
    task.tolerance = kShareOfBound * options.bound * mean;
    forTiles(camera, "doubling", [&](int x, int y) {
      Tile tile(task, x, y);
      MediaReference own;
      refineTile(tile, medium.density != nullptr, options.bound * mean, options, radiance, own);
      const std::lock_guard lock(merging);  // maxima and sums of integers: in any order the same
      reference.worstChange = std::max(reference.worstChange, own.worstChange);
      reference.doublings = std::max(reference.doublings, own.doublings);
      reference.atLimit += own.atLimit;
      reference.rays += own.rays;
    });
  }
  reference.mean = meanOf(radiance);
  if (reference.mean > 0.0) reference.worstChange /= reference.mean;
  reference.inScattered = ImageF(camera.width, camera.height, 3);
  for (size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c)
      reference.inScattered.values[3 * i + static_cast<size_t>(c)] = static_cast<float>(radiance[i][c]);
  reference.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

}  // namespace gnomon
