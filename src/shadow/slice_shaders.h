#pragma once
// How a parameterization's slices are drawn. Part of the fit (FittedMap::shaders), and all that MapRenderer knows about
// the parameterization.
//
// Every shader reads the scene's bindings, the map's uniforms at kBindMap and, as push constants, as much of the front
// of SlicePush as it needs (shadow/drawn_slice.glsl). Specialization constants: 0 is kMasked, 1 leaves the holes of
// alpha masks open; 1 is kPass*; 2 is the map's kind (kMap*); 3 is 1 where one pass draws all slices; 4 is the
// channels that the pass stores.

#include <cstdint>

namespace gnomon {

// How often the triangles of a projective map are sent on their way.
enum class SlicePasses {
  Auto,       // whichever is faster on the device, of what is right on it
  Each,       // once a slice
  Multiview,  // once for all slices, where the device draws them as it does one by one
};

struct SliceShaders {
  const char* vertex = "shadow/project_to_slice.vert.glsl";
  // Ends in storeChannels (shadow/store_channels.glsl).
  const char* fragment = "shadow/draw_depth.frag.glsl";
  // Depth is the rasterizer's own: where there is nothing else to store, opaque meshes need no fragment shader.
  bool rasterizedDepth = true;
  // Empty: indexed triangles, whose corners the vertex shader projects and which the rasterizer culls by winding. Else
  // a compute shader that writes the triangles a slice shows, each with four corners around its projection
  // (shared/bounded_triangle.glsl): these are drawn by shadow/pull_bounded_triangle.vert.glsl, and the fragment shaders
  // decide each texel. Or one that writes triangles of its own for a vertex shader of its own, in the same buffer
  // (shared/straight_triangle.glsl).
  const char* bounds = "";
  // A second one after it, for those that it left over as large; empty: it leaves none.
  const char* largeBounds = "";
  // One bit a slice that mirrors: there, what winds counter-clockwise seen from the light is clockwise on the slice.
  uint32_t mirroredSlices = 0;
  // The slices are clipFromLight's: what its sides do not let through need not be drawn.
  bool projective = true;
  SlicePasses passes = SlicePasses::Each;  // of projective slices that mirror all, or none

  bool operator==(const SliceShaders&) const = default;
};

// Push constants of the vertex and fragment shaders, in this order.
struct SlicePush {
  int32_t slice = 0;
  // Of depth: what lies no further behind the first layer is not the second. The same triangle gets the same
  // depth in every pass, so none is needed.
  float tolerance = 0.0f;
  uint32_t rangeTriangle = 0;  // the first of the triangles that are drawn, in the array of all
  uint32_t rangeId = 0;        // its id (scene/triangle_ids.h)
};

}  // namespace gnomon
