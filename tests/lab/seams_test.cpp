// Where slices meet, a map is no worse than elsewhere: pixels within two texels of a paraboloid's rim or of a
// cube's edge against the others, and against themselves with the seam turned away.
#include "lab/compare/compare.h"
#include "lab/core/maps.h"
#include "omni/paraboloid_map.h"

#include "tests/base/places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

constexpr double kNearSeam = 2.0;  // texels: as far as jitter4x4 reaches

struct Zone {
  size_t pixels = 0, wrong = 0;  // wrong: acne and leaks, without a filter
  double squares = 0.0;          // of visibility against the truth through the filter
  double biasError() const { return static_cast<double>(wrong) / static_cast<double>(pixels); }
  double rmse() const { return std::sqrt(squares / static_cast<double>(pixels)); }
};

// One scene, seen by its first camera and lit by its first point light.
class Seams {
 public:
  explicit Seams(const std::string& scene)
      : session_({.validation = true}, {.scene = scene, .size = "384"}),
        passes_(session_),
        light_(openLight(session_, passes_, *parseMaps("paraboloid").front(), {})) {}

  // The seam's plane holds the light, what the middle of the picture shows, and the camera's up: it runs
  // through the picture from top to bottom.
  glm::dvec3 axisThroughTheMiddle() const {
    const Receivers& receivers = light_.receivers();
    const auto middle = static_cast<std::ptrdiff_t>(receivers.states.size() / 2 + receivers.width / 2);
    std::ptrdiff_t nearest = -1;
    for (std::ptrdiff_t i = 0; i < std::ssize(receivers.states); ++i)
      if (receivers.states[i] == PixelState::Scored &&
          (nearest < 0 || std::abs(i - middle) < std::abs(nearest - middle)))
        nearest = i;
    const glm::dvec3 toMiddle = receivers.samples[nearest].positionW - light_.light().positionW;
    return glm::normalize(glm::cross(toMiddle, glm::dvec3(session_.view().upW)));
  }

  LightOnMap mapped(const char* map, int side, const MapOptions& options) {
    return openLight(session_, passes_, *parseMaps(map).front(), {.side = side, .options = options});
  }

  // Of each pixel; infinity where it is not scored.
  std::vector<double> texelsToSeam(const FittedMap& fitted) const {
    const Receivers& receivers = light_.receivers();
    std::vector<double> texels(receivers.states.size(), INFINITY);
    for (size_t i = 0; i < texels.size(); ++i) {
      if (receivers.states[i] != PixelState::Scored) continue;
      const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(receivers.samples[i].positionW));
      const glm::dvec2 fromCenter = glm::dvec2(glsl::mapProject(fitted.map, posL).uv) - 0.5;
      const double reach = fitted.map.kind == glsl::kMapParaboloid
                               ? glm::length(fromCenter)
                               : std::max(std::abs(fromCenter.x), std::abs(fromCenter.y));
      texels[i] = (0.5 - reach) * fitted.map.width;
    }
    return texels;
  }

  // By one fit: what each pixel is, and through each filter the square of what its visibility is off.
  struct Scores {
    LabelImage labels;
    std::vector<std::vector<double>> squares;
  };
  Scores score(LightOnMap& lit, const char* bias) const {
    const Method method = atDefaults(findBias(bias), session_);
    const LabelledResult judged = lit.judge(method);
    Scores scores{.labels = judged.labels, .squares = {}};
    for (const Filter& filter : filters()) {
      const std::vector<float> truth = lit.filteredTruth(filter.id);
      std::vector<float> visibility = lit.visibility(method, filter.id);
      for (const size_t pixel : judged.edgeOn) visibility[pixel] = truth[pixel];
      std::vector<double>& squares = scores.squares.emplace_back(truth.size());
      for (size_t i = 0; i < truth.size(); ++i)
        squares[i] = std::pow(static_cast<double>(visibility[i]) - static_cast<double>(truth[i]), 2);
    }
    return scores;
  }

  // Pixels with `distance` up to kNearSeam, and the rest.
  std::array<Zone, 2> zones(const Scores& scores, size_t filter, const std::vector<double>& distance) const {
    std::array<Zone, 2> zones;
    for (size_t i = 0; i < distance.size(); ++i) {
      if (light_.receivers().states[i] != PixelState::Scored) continue;
      Zone& zone = zones[distance[i] <= kNearSeam ? 0 : 1];
      const Label label = scores.labels.labels[i];
      ++zone.pixels;
      zone.wrong += label == Label::Acne || label == Label::Leak ? 1 : 0;
      zone.squares += scores.squares[filter][i];
    }
    return zones;
  }

  const gpu::Device& device() const { return session_.device(); }

 private:
  Session session_;
  ShadowPasses passes_;
  LightOnMap light_;
};

// A sum of errors of at most 1 each scatters by the root of its expectation; three of those are in hand.
void expectNoMore(double sum, double expected, const std::string& what) {
  EXPECT_LE(sum, expected + 3.0 * std::sqrt(expected + 1.0)) << what;
}

class SeamsTest : public ::testing::TestWithParam<const char*> {};

TEST_P(SeamsTest, ShowNoMoreErrorThanElsewhere) {
  std::string scene = GetParam();
  if (scene.ends_with(".glb")) {
    scene = test::inSource("../shared/scenes") + "/" + scene;
    if (!std::filesystem::is_directory(test::inSource("../shared/scenes")))
      GTEST_SKIP() << "skipped: ../shared/scenes is not here";
  }
  Seams seams(scene);
  LightOnMap through = seams.mapped("paraboloid", 887, {kParaboloidAxisW(seams.axisThroughTheMiddle())});
  LightOnMap away = seams.mapped("paraboloid", 887, {});
  LightOnMap cube = seams.mapped("cube", 512, {});
  for (const char* bias : {"adaptive", "dual"}) {
    const Seams::Scores turned = seams.score(away, bias);
    for (LightOnMap* lit : {&through, &cube}) {
      const std::vector<double> distance = seams.texelsToSeam(lit->fitted());
      const Seams::Scores scores = seams.score(*lit, bias);
      for (size_t f = 0; f < filters().size(); ++f) {
        const auto [at, elsewhere] = seams.zones(scores, f, distance);
        const Zone same = seams.zones(turned, f, distance)[0];
        const std::string what = fmt::format(
            "{} {} {}: {} pixels at the seam; bias error {:.3f}% (elsewhere {:.3f}%, turned away {:.3f}%), "
            "rmse {:.4f} ({:.4f}, {:.4f})",
            lit == &cube ? "cube" : "paraboloid", bias, filters()[f].name, at.pixels, 100.0 * at.biasError(),
            100.0 * elsewhere.biasError(), 100.0 * same.biasError(), at.rmse(), elsewhere.rmse(), same.rmse());
        EXPECT_GT(at.pixels, 300u) << what;
        const auto pixels = static_cast<double>(at.pixels);
        expectNoMore(static_cast<double>(at.wrong), pixels * elsewhere.biasError(), what);
        // Where a shadow's edge runs along the seam there is more to be wrong about than elsewhere.
        expectNoMore(at.squares, pixels * std::pow(std::max(elsewhere.rmse(), same.rmse()), 2), what);
      }
    }
  }
  EXPECT_TRUE(seams.device().validationMessages().empty());
}

INSTANTIATE_TEST_SUITE_P(Scenes, SeamsTest, ::testing::Values("corner", "atrium", "level_rpg3dm2.glb"),
                         [](const auto& tested) {
                           const std::string name = tested.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace gnomon
