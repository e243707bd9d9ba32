#pragma once
// The interface of a parameterization: it fits itself to a scene and a light, and says how its slices are drawn. Its
// mathematics (mapProject, mapTexelRay, mapDepth, mapDepthSlope, mapDistance) is in shaders/shared/map.glsl, and a
// FittedMap carries the numbers those functions read.
//
// Spot and directional maps are in planar/, cube and paraboloid maps in omni/, the shadow volume in vsv/; the list of
// all is in lab/core/maps.h.

#include "scene/light_model.h"
#include "scene/scene_buffers.h"
#include "shadow/bias.h"
#include "shadow/map_options.h"
#include "shadow/slice_shaders.h"

#include "shared/light_frame.glsl"
#include "shared/map.glsl"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

class Occluders;

struct FittedMap {
  glsl::LightFrame frame;
  glsl::ShadowMap map;
  // Clip distances of slice 0 along the light's axis, metres; for reports.
  float zNear = 0.0f;
  float zFar = 0.0f;
  bool positional = true;  // the light is a point, and L's origin is there
  SliceShaders shaders;
  // What a report should say of the fit: why a warp was weakened or not applied. Empty: nothing.
  std::string note = {};
  // Slices that show only what lies to one side of a point light, and how far behind it (over the distance) all the
  // same; one a slice, or empty.
  struct HalfSpace {
    float axisZ = 1.0f;  // of L: +1 or -1
    float beyond = 0.0f;
  };
  std::vector<HalfSpace> halfSpaces = {};
  // Where each slice's square stands in an unfolded picture, in squares; empty: side by side.
  std::vector<glm::ivec2> unfoldedAt = {};
  // Of a shadow volume's columns: the map in which their occluders are looked up; none: their own slice is drawn.
  std::shared_ptr<const FittedMap> occluderSource;
};

// What a map may be fitted to.
struct FitInput {
  const Scene& scene;
  const LightModel& light;
  std::span<const glm::dvec3> receiversW;  // the scored points the camera sees
  int side = 1024;                         // texels
  const glsl::CameraView& camera;          // what warps and cascades are made for
  MapOptions options = {};
};

// Whether a map can be made of a kind of light.
enum class LightSupport {
  No,
  Fallback,  // where the scene has no light of a better kind
  Yes,
};

class Parameterization {
 public:
  virtual ~Parameterization() = default;
  virtual const char* name() const = 0;      // on the command line: --maps spot
  virtual const char* sentence() const = 0;  // for --help
  virtual int sliceCount(const MapOptions& options) const = 0;
  // A spot map takes any positional light; a directional map makes a sun of one where the scene has no
  // directional light.
  virtual LightSupport supportsLight(LightType type) const = 0;
  // Whether lightModel() reads `aimW` for a light of this kind: it takes a trace to find.
  virtual bool needsAim(LightType) const { return false; }
  // How a light is taken. `aimW` is the unit direction in which a light without one of its own is made to
  // shine. The light is of a kind that is supported.
  virtual LightModel lightModel(const Light& light, const glm::dvec3& aimW) const = 0;
  // Whether a bias means anything on it, and whether its texels can be filtered: a shadow volume holds no depths.
  virtual bool supportsBias(const BiasMethod&) const { return true; }
  virtual bool supportsFilters() const { return true; }
  virtual FittedMap fit(const FitInput& input) const = 0;
  // Room on the device for what fit() gave, not drawn yet (occluders.h): a map image, unless it is overridden. Throws
  // WorldError where the device cannot hold it.
  virtual std::unique_ptr<Occluders> createOccluders(const gpu::Device& device, const FittedMap& fitted,
                                                     ChannelSet channels) const;

  // Its options, which flags, --help, results.json and commands derive from. An option that two maps share is one
  // constant, which both name.
  virtual std::vector<const MapOption*> options() const { return {}; }
  // Throws UsageError where choices do not go together.
  virtual void checkOptions(const MapOptions&) const {}
  // What the params of its rows say of a fit, beside the options: names and texts.
  virtual std::vector<std::pair<std::string, std::string>> fitParams(const FittedMap&) const { return {}; }
  // Those of half the resolution, where options say what that is beside FitInput::side.
  virtual MapOptions halved(const MapOptions& given) const { return given; }
  // Other ways to draw it that a bench should time.
  struct Variant {
    std::string name;
    MapOptions options;
  };
  virtual std::vector<Variant> variants(const MapOptions& /*given*/) const { return {}; }
  // Whether it holds every direction around a light, so that a view ray can be marched through a medium with it.
  virtual bool looksAround() const { return false; }
};

}  // namespace gnomon
