#pragma once
// Choices of how a map is fitted and drawn that a user may make: each parameterization reads what concerns
// it.

#include "shadow/layer_shaders.h"

#include <array>
#include <optional>
#include <string>

#include <glm/glm.hpp>

namespace gnomon {

// What the window of a planar map encloses.
enum class WindowFit {
  None,     // the whole scene (directional), the whole cone (spot)
  Tight,    // the camera's frustum cut to the scene
  Focused,  // the surfaces that the camera sees and the light faces
};

// Shapes a planar map's texels to the camera (Real-Time Rendering, 3rd edition, section 9.1.4).
enum class Warp {
  None,
  Psm,     // perspective shadow maps: Stamminger and Drettakis 2002
  Lispsm,  // light space perspective shadow maps: Wimmer, Scherzer, Purgathofer 2004
  Tsm,     // trapezoidal shadow maps: Martin and Tan 2004
};

// How a cube map stores depth.
enum class CubeDepth {
  Hyperbolic,  // the rasterizer's own z/w of the face
  Radial,      // linear in the distance from the light
};

// How the triangles of a dual paraboloid are rasterized.
enum class ParaboloidRaster {
  Vertex,       // corners are projected, edges are drawn straight: wrong for large triangles (Brabec et al. 2002)
  Tessellated,  // the same, of triangles cut until their edges are straight to within half a texel
  Exact,        // each texel's ray meets the triangle or does not
};

inline constexpr int kMostCascades = 4;

// Voxels of a shadow volume along its three angles (shaders/shared/epipolar.glsl); phi a multiple of 128.
struct VolumeSize {
  int alpha = 1024, theta = 1024, phi = 512;
  bool operator==(const VolumeSize&) const = default;
};

// Where the occluders of a shadow volume come from.
enum class VolumeSource {
  Resample,  // a cube map of the scene, looked up along each column (the papers' way)
  Direct,    // the scene itself, drawn into (theta, phi), each column deciding by its own ray
};

// What alpha, theta and phi of a shadow volume cover.
enum class VolumeFit {
  Frustum,  // what the camera sees, from the eye to the surfaces
  Full,     // the whole sphere, as in the papers
};

struct MapOptions {
  WindowFit fit = WindowFit::Focused;
  bool snap = true;  // texels keep their places in the world while the camera moves; warped ones cannot
  Warp warp = Warp::None;
  int cascades = 1;  // directional maps: layers, finest first
  CubeDepth cubeDepth = CubeDepth::Hyperbolic;
  LayerPasses cubePasses = LayerPasses::Auto;
  ParaboloidRaster paraboloidRaster = ParaboloidRaster::Exact;
  std::optional<glm::dvec3> paraboloidAxisW;  // unit; absent: the seam is turned away from what the camera sees
  VolumeSize volumeSize;
  VolumeSource volumeSource = VolumeSource::Direct;
  VolumeFit volumeFit = VolumeFit::Frustum;
};

// Throws UsageError that names the flags: --cascades outside 1..kMostCascades, or together with --warp, which
// would shape every cascade to the whole view.
void checkMapOptions(const MapOptions& options);

// Whether a planar map of these options snaps.
bool snaps(const MapOptions& options);

// By their names on the command line. Each throws UsageError that names the flag and lists the choices.
WindowFit parseWindowFit(const std::string& name);                // none, tight, focused
Warp parseWarp(const std::string& name);                          // none, psm, lispsm, tsm
CubeDepth parseCubeDepth(const std::string& name);                // hyperbolic, radial
LayerPasses parseCubePasses(const std::string& name);             // auto, six, multiview
bool parseSnap(const std::string& name);                          // on, off
ParaboloidRaster parseParaboloidRaster(const std::string& name);  // vertex, tessellated, exact
VolumeSize parseVolumeSize(const std::string& text);              // AxTxP
VolumeSource parseVolumeSource(const std::string& name);          // resample, direct
VolumeFit parseVolumeFit(const std::string& name);                // frustum, full
const char* windowFitName(WindowFit fit);
const char* warpName(Warp warp);
const char* cubeDepthName(CubeDepth depth);
const char* cubePassesName(LayerPasses passes);
const char* paraboloidRasterName(ParaboloidRaster raster);
// Half of each side, as far as that is a size.
VolumeSize halvedSize(const VolumeSize& size);
std::string volumeSizeName(const VolumeSize& size);
const char* volumeSourceName(VolumeSource source);
const char* volumeFitName(VolumeFit fit);

}  // namespace gnomon
