#pragma once
// One light as one parameterization models it, in one picture: its ground truth, the fit, the rendered map or volume,
// each pixel's visibility by any bias, and why it is wrong where it is.
//
//   ShadowPasses passes(view);
//   LightOnMap lit(view, passes, cubeParameterization(), {.side = 512});
//   const LabelledResult result = lit.judge(atDefaults(findBias("adaptive"), view));
//
// Each is computed when it is first needed, and cached.

#include "judge/ground_truth.h"
#include "judge/shadow_passes.h"
#include "truth/labels.h"

#include "shared/bias_params.glsl"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

// A bias with its knobs set.
struct Method {
  const BiasMethod* bias = nullptr;
  glsl::BiasParams params{};
  bool operator==(const Method& other) const;
};
Method atDefaults(const BiasMethod& bias, const SceneView& view);

struct MapSetup {
  int side = 1024;  // texels of a slice
  MapOptions options = {};
  CullMode cull = CullMode::Solids;
  // What the map is fitted to; absent: the scored points that the camera sees; empty: the whole scene.
  std::optional<std::vector<glm::dvec3>> receiversW = {};
  // Of pictures, per cd/m^2; absent: as LightOnMap::exposure says.
  std::optional<float> exposure = {};
};

// What the walks of `witness` came to, of all scored pixels (shared/sheet_walk.glsl).
struct WalkCounts {
  size_t walks = 0, steps = 0;
  uint32_t longest = 0;  // steps
  std::array<size_t, glsl::kWalkEndCount> ends{};
};

// One bias on one map, without a filter.
struct LabelledResult {
  std::vector<float> visibility;  // one a pixel
  std::vector<Verdict> verdicts;
  LabelImage labels;
  // Scored pixels that the shader's floats take for facing away: edge-on to the light or the camera within
  // rounding, where no light arrives either way. They count as agreeing.
  std::vector<size_t> edgeOn;
  size_t grazing = 0;  // scored pixels whose texel ray does not meet their plane between near and far
  WalkCounts walks;    // none but of witness
};

Verdict verdictOf(const glsl::PixelDiagnosis& pixel);
// What the visibility pass writes of an unfiltered pixel. `empty`: there is no surface.
float visibilityOf(const glsl::PixelDiagnosis& pixel, bool empty);

// The light ray through the centre of the texel that decided a pixel, in the world. `texelWord`: PixelDiagnosis::texel.
RayD texelRayW(const FittedMap& fitted, uint32_t texelWord);

struct Exposure {
  glm::vec3 lightColor{1.0f};  // radiant intensity over pi; of a directional light irradiance over pi
  glm::vec3 ambient{0.0f};
};

class LightOnMap {
 public:
  LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, const Light& source,
             MapSetup setup);
  // Of firstLightFor(). Throws WorldError where there is none.
  LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, MapSetup setup);
  // The light taken as it was for another view.
  LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, const Light& source,
             const LightModel& light, MapSetup setup);
  // The same light, ground truth and parameterization, mapped otherwise.
  LightOnMap(const LightOnMap& other, MapSetup setup);

  // What another map of the same parameterization took of the device: its room, to be drawn into anew where this one
  // has the same form, or the map as it is, fit and depths, of a light that is taken alike. The other is then without.
  void takeRoomOf(LightOnMap& other);
  void takeMapOf(LightOnMap& other);

  const SceneView& view() const { return view_; }
  ShadowPasses& passes() const { return passes_; }
  const Parameterization& parameterization() const { return map_; }
  const MapSetup& setup() const { return setup_; }
  const Light& source() const { return source_; }     // as the scene or the command line has it
  const LightModel& light() const { return light_; }  // as the map takes it

  const GroundTruth& groundTruth() const;
  const Receivers& receivers() const { return groundTruth().receivers; }
  const Truth& truth() const { return groundTruth().truth; }

  const FittedMap& fitted() const;
  double fitMs() const;  // wall clock, milliseconds

  // Drawn with what a bias reads of them (BiasMethod::channels).
  const Occluders& occluders(ChannelSet channels = glsl::kChannelDepth);
  // Wall clock of drawing them once more, milliseconds.
  double redraw(ChannelSet channels = glsl::kChannelDepth);

  // One value a pixel, through a filter.
  std::vector<float> visibility(const Method& method, const ChosenFilter& filter = glsl::kShadowFilterNone);
  // Compiles what timeVisibility() runs: drivers put that off to the first pixel.
  void warmUp(const Method& method, const ChosenFilter& filter = glsl::kShadowFilterNone);
  double timeVisibility(const Method& method,
                        const ChosenFilter& filter = glsl::kShadowFilterNone);  // wall clock, milliseconds
  // Of the unfiltered map: how each pixel was decided, and by which texel.
  std::vector<glsl::PixelDiagnosis> diagnose(const Method& method);
  LabelledResult judge(const Method& method);
  // What diagnose() and judge() will be asked for next. Methods that one dispatch can decide (DecisionPass) are decided
  // together when the first of them is asked for; the bits are the same.
  void expect(std::vector<Method> methods);

  // The truth through a filter (filtered_truth.h), and texels a square metre of each pixel's surface (texel_density.h).
  std::vector<float> filteredTruth(const ChosenFilter& filter) const;
  std::vector<float> texelDensities() const;

  // The setup's, or one by which a typical lit surface is neither dark nor burnt: a white one that faces the light at
  // the median distance of what is lit has radiance 0.75.
  Exposure exposure() const;
  // The same as a factor per cd/m^2, of the light as the file or the command line has it.
  double exposureFactor() const;
  // Linear rgb by one visibility a pixel.
  ImageF radiance(std::span<const float> visibility, const Exposure& exposure) const;
  ImageF radiance(std::span<const float> visibility) const { return radiance(visibility, exposure()); }
  // The same by one method, in one pass where the occluders have it.
  ImageF picture(const Method& method, const ChosenFilter& filter = glsl::kShadowFilterNone);
  // Wall clock of that pass, with the occluders drawn before it or without; milliseconds. Of a map.
  double timeFrame(const Method& method, const ChosenFilter& filter, bool redrawn);

 private:
  struct Fit {
    FittedMap fitted;
    double ms = 0.0;
  };
  const Fit& fit() const;
  struct Decided {
    std::vector<Method> methods;
    Decisions decisions;
  };
  double timeLookup(const Method& method, const ShadowLookup& lookup);
  // By `decided_`, to which those are added that are expected beside it; none: it has to be decided alone.
  std::optional<std::vector<glsl::PixelDiagnosis>> diagnoseTogether(const Method& method);
  glsl::ShadeUniforms exposedUniforms(const Exposure& exposure, const glsl::BiasParams& params) const;

  const SceneView& view_;
  ShadowPasses& passes_;
  const Parameterization& map_;
  const MapSetup setup_;
  const Light source_;
  const LightModel light_;
  mutable std::shared_ptr<const GroundTruth> truth_;
  mutable std::optional<Fit> fit_;
  std::map<ChannelSet, std::unique_ptr<Occluders>> occluders_, room_;
  std::vector<Method> expected_;
  std::map<ChannelSet, Decided> decided_;  // the last ones
};

}  // namespace gnomon
