// A shadow map is an array of slices and four functions (mapProject, mapTexelRay, mapDepth, mapDepthSlope) plus
// the inverse of depth along a ray. Everything else, biases, filters, labels, knows maps only through these.
//
// Frame: L, the light's. Its origin is the light (for a directional light a point near the scene), units are metres.
//
//     uv (0,0) +-----> u          a texel's ray passes through the texel's centre;
//              |  . . .           depth is 0 at its near end and 1 at its far end
//              v  . . .           and grows strictly in between
//
// A parameterization is a case in each of the switches, and a file of its own beside this one.
#ifndef GNOMON_MAP_GLSL
#define GNOMON_MAP_GLSL

#include "shared/epipolar.glsl"
#include "shared/geometry.glsl"
#include "shared/lang.glsl"
#include "shared/light_frame.glsl"

GNOMON_SHARED_BEGIN

const int kBindMap = 16;  // MapUniforms; declared here, in every shader that includes this file

const int kMapPlanar = 0;      // spot and directional: one clipFromLight matrix a slice
const int kMapCube = 1;        // six faces, hyperbolic depth: z/w of the face's own projection
const int kMapCubeRadial = 2;  // six faces, depth linear in the distance from the light
const int kMapParaboloid = 3;  // two hemispheres, depth linear in the distance from the light
const int kMapEpipolar = 4;    // the columns of a shadow volume: light rays (theta, phi), depth grows with alpha
const int kMaxMapSlices = 6;

// A shader of one kind of map defines GNOMON_MAP_KIND, a constant: the branches below are then decided before any
// function is inlined, and the other kinds' code is gone from its pipelines (src/gpu/specialize.h).
#ifdef GNOMON_MAP_KIND
#define mapKind(map) GNOMON_MAP_KIND
#else
#define mapKind(map) (map).kind
#endif

struct MapSlice {
  mat4 clipFromLight;  // Vulkan clip space: y down, z in [0, w]
  mat4 lightFromClip;
};

struct ShadowMap {
  int kind;  // kMap*
  int sliceCount;
  int width;         // texels along u
  int height;        // texels along v: as many, but in epipolar maps
  float sceneScale;  // metres: the diagonal of the scene's bounds
  // Metres, where depth is 0 and 1: along a cube face's axis, or from the light where depth is radial. A planar map has
  // them in its matrices.
  float zNear;
  float zFar;
  // Cube faces: z_clip = m * clipDepth.x + clipDepth.y. In the buffer, because a shader's optimizer that sees what it
  // is made of factors the sum, and then the bits are no longer the rasterizer's.
  vec2 clipDepth;
  EpipolarGrid epipolar;
  GNOMON_PUBLIC_ONLY(LightFrame frame;)
  GNOMON_PUBLIC_ONLY(int source;)  // which of your maps: for your fetches
  GNOMON_CPP_ONLY(MapSlice mapSlices[kMaxMapSlices];)
};

// A fitted map as a uniform buffer: lavapipe reads those once for all pixels of a group, where a storage buffer is read
// pixel by pixel (measured: the visibility pass 1.7 times slower). In GLSL it is declared member by member
// (GNOMON_MEMBER_ARRAY in lang.glsl says why).
GNOMON_CPP_ONLY(struct MapUniforms {
  LightFrame lightFrame;
  ShadowMap shadowMap;
};)
GNOMON_GLSL_ONLY(layout(scalar, binding = kBindMap) uniform MapUniforms {
  LightFrame lightFrame;
  ShadowMap shadowMap;
  MapSlice mapSlices[kMaxMapSlices];
};)

struct MapPoint {
  int slice;
  vec2 uv;  // [0,1]^2 where covered
  bool covered;
};

GNOMON_SHARED_END

#include "shared/cube_map.glsl"
#include "shared/epipolar_map.glsl"
#include "shared/paraboloid_map.glsl"
#include "shared/planar_map.glsl"

GNOMON_SHARED_BEGIN

// Which slice and where on it a point falls, and whether the map covers it at all.
GNOMON_FN MapPoint mapProject(ShadowMap map, vec3 posL) {
  switch (mapKind(map)) {
    case kMapPlanar:
      return planarProject(map, posL);
    case kMapCube:
    case kMapCubeRadial:
      return cubeProject(posL);
    case kMapParaboloid:
      return paraboloidProject(posL);
    case kMapEpipolar:
      return epipolarMapProject(map, posL);
  }
  MapPoint none;
  none.slice = 0;
  none.uv = vec2(0.0f, 0.0f);
  none.covered = false;
  return none;
}

// The light ray through uv of a slice. Its origin is where depth is 0.
GNOMON_FN Ray mapTexelRay(ShadowMap map, int slice, vec2 uv) {
  switch (mapKind(map)) {
    case kMapPlanar:
      return planarTexelRay(map, slice, uv);
    case kMapCube:
    case kMapCubeRadial:
      return cubeTexelRay(map, slice, uv);
    case kMapParaboloid:
      return paraboloidTexelRay(map, slice, uv);
    case kMapEpipolar:
      return epipolarMapTexelRay(map, uv);
  }
  Ray none;
  none.origin = vec3(0.0f, 0.0f, 0.0f);
  none.dir = vec3(0.0f, 0.0f, -1.0f);
  return none;
}

// The depth a slice stores for a point; outside [0,1] before the near end and beyond the far one.
GNOMON_FN float mapDepth(ShadowMap map, int slice, vec3 posL) {
  switch (mapKind(map)) {
    case kMapPlanar:
      return planarDepth(map, slice, posL);
    case kMapCube:
    case kMapCubeRadial:
      return cubeDepth(map, slice, posL);
    case kMapParaboloid:
      return paraboloidDepth(map, posL);
    case kMapEpipolar:
      return epipolarMapDepth(map, posL);
  }
  return 0.0f;
}

// d depth / d metre at a point, along the unit direction of a texel's ray: f'(x) of Dou et al. 2014, equation 2.
GNOMON_FN float mapDepthSlope(ShadowMap map, int slice, vec3 posL, vec3 rayDir) {
  switch (mapKind(map)) {
    case kMapPlanar:
      return planarDepthSlope(map, slice, posL, rayDir);
    case kMapCube:
    case kMapCubeRadial:
      return cubeDepthSlope(map, slice, posL, rayDir);
    case kMapParaboloid:
      return paraboloidDepthSlope(map);
    case kMapEpipolar:
      return epipolarMapDepthSlope(map, posL, rayDir);
  }
  return 0.0f;
}

// Metres from the ray's origin to where the map's depth is `depth`: the inverse of mapDepth along a texel's ray.
GNOMON_FN float mapDistance(ShadowMap map, int slice, Ray ray, float depth) {
  switch (mapKind(map)) {
    case kMapPlanar:
      return planarDistance(map, slice, ray, depth);
    case kMapCube:
    case kMapCubeRadial:
      return cubeDistance(map, slice, ray, depth);
    case kMapParaboloid:
      return paraboloidDistance(map, depth);
    case kMapEpipolar:
      return epipolarMapDistance(map, ray, depth);
  }
  return 0.0f;
}

// What a fragment shader of one kind of map needs of it while it is drawn (shadow/bounded_varyings.glsl), in an order
// that its own functions know.
GNOMON_FN vec4 mapDrawnNumbers(ShadowMap map) {
  switch (mapKind(map)) {
    case kMapParaboloid:
      return paraboloidDrawnNumbers(map);
    case kMapEpipolar:
      return epipolarMapThetaNumbers(map);
  }
  return vec4(0.0f, 0.0f, 0.0f, 0.0f);
}

// And more of them.
GNOMON_FN vec4 mapMoreDrawnNumbers(ShadowMap map) { return epipolarMapPhiNumbers(map); }

GNOMON_FN vec2 mapTexelCounts(ShadowMap map) { return vec2(float(map.width), float(map.height)); }

// The texel that holds uv; uv = 1 belongs to the last one.
GNOMON_FN ivec2 mapTexel(ShadowMap map, vec2 uv) {
  return ivec2(clamp(int(floor(uv.x * float(map.width))), 0, map.width - 1),
               clamp(int(floor(uv.y * float(map.height))), 0, map.height - 1));
}

GNOMON_FN vec2 mapTexelCenter(ShadowMap map, ivec2 texel) {
  return vec2((float(texel.x) + 0.5f) / float(map.width), (float(texel.y) + 0.5f) / float(map.height));
}

// Whether a slice draws a texel of its rectangle, by the centre in texels, which the rasterizer has at hand: with the
// texel's numbers instead, the exact drawing of a paraboloid took a sixteenth longer.
GNOMON_FN bool mapHoldsTexelAt(ShadowMap map, vec2 center) {
  return mapKind(map) != kMapParaboloid || paraboloidHoldsTexelAt(float(map.width), center);
}

// Whether a slice draws this texel: it lies on its rectangle, and where the slice is less than that, within it.
GNOMON_FN bool mapHoldsTexel(ShadowMap map, int slice, ivec2 texel) {
  if (!mapHoldsTexelAt(map, vec2(float(texel.x) + 0.5f, float(texel.y) + 0.5f))) return false;
  return slice < map.sliceCount && texel.x >= 0 && texel.y >= 0 && texel.x < map.width && texel.y < map.height;
}

struct MapTexel {
  int slice;
  ivec2 texel;
  bool held;  // by some slice
};

// The texel that a look-up for a receiver at posL means, which may lie beyond its slice's edge: there the ray of the
// missing texel, by the same formula continued, is followed to where it passes the receiver, and that point looked up
// in whatever slice holds it. So a filter that crosses a cube's edge, a paraboloid's rim, a cascade's border or theta's
// seam reads what the light sees there.
GNOMON_FN MapTexel mapTexelAcross(ShadowMap map, int slice, ivec2 texel, vec3 posL) {
  MapTexel found;
  found.slice = slice;
  found.texel = texel;
  found.held = mapHoldsTexel(map, slice, texel);
  if (!found.held) {
    Ray ray = mapTexelRay(map, slice, mapTexelCenter(map, texel));
    MapPoint point = mapProject(map, ray.origin + ray.dir * dot(posL - ray.origin, ray.dir));
    found.slice = point.slice;
    found.texel = mapTexel(map, point.uv);
    found.held = point.covered;
  }
  return found;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::ShadowMap) == 76 + 6 * 128);
static_assert(offsetof(gnomon::glsl::ShadowMap, mapSlices) == 76);
static_assert(sizeof(gnomon::glsl::MapUniforms) == 48 + 844);
#endif
#endif
