#pragma once
// The inputs that all integrators share: the medium, its lights, the ends of the view rays, and the surfaces behind the
// medium, shaded with the exact shadow.

#include "lab/core/session.h"
#include "truth/media_reference.h"
#include "vsv/media/density.h"
#include "vsv/media/media_pass.h"
#include "vsv/media/media_receivers.h"

#include <optional>

namespace gnomon {

// As asked for; what is absent follows from the scene.
struct FogMedium {
  std::optional<glm::vec3> sigmaS;  // 1/m; absent: grey, so that the scene's diagonal is half an optical depth
  glm::vec3 sigmaA{0.0f};           // 1/m
  float g = 0.2f;
  std::optional<double> reach;                 // metres; absent: to the farthest corner of the scene's bounds
  float ambient = 0.0f;                        // cd/m^2 that a white surface reflects besides
  std::shared_ptr<const DensityGrid> density;  // none: homogeneous
};

// The default's optical depth.
inline constexpr double kDefaultOpticalDepth = 0.5;

struct FogView {
  std::vector<Light> lights;
  std::vector<MediaLightSource> sources;  // one a light
  std::vector<MediaLight> exactLights;    // the same
  glsl::Medium medium{};
  MediumModel model;
  std::shared_ptr<const DensityGrid> density;  // that model.density points to
  std::shared_ptr<const DensityBuffers> densityBuffers;
  std::vector<double> ends;            // metres along each pixel's ray
  std::vector<glm::dvec3> receiversW;  // what volumes and maps are fitted to
  ImageF surface;                      // rgb, cd/m^2: attenuated along both legs
};

// The lights that --light names: point and spot lights. Throws WorldError.
std::vector<Light> fogLights(const Session& session);

FogView lookIntoFog(const SceneView& scene, ShadowPasses& passes, const std::vector<Light>& lights,
                    const FogMedium& medium);

// How radiance becomes a picture: the same factor for all pictures of a run.
struct FogExposure {
  float factor = 1.0f;  // per cd/m^2
};
// The 99th percentile of the largest channel comes to 0.9.
FogExposure exposureFor(const FogView& view, const ImageF& inScattered);
FogExposure mediumExposureFor(const ImageF& inScattered);

// Surfaces and medium together, rgb, cd/m^2.
ImageF composed(const FogView& view, const ImageF& inScattered);
Image8 exposed(const ImageF& radiance, const FogExposure& exposure);

}  // namespace gnomon
