// The frame pass (src/shadow/frame_pass.h): what a draw says of itself, and what its corners send to its pixels.
#ifndef GNOMON_FRAME_DRAW_GLSL
#define GNOMON_FRAME_DRAW_GLSL

#include "shared/filter.glsl"
#include "shared/scene.glsl"
#include "shared/shade.glsl"

// FramePush in src/shadow/frame_pass.cpp. Push constants are read once for all pixels, where lavapipe reads a storage
// buffer lane by lane.
layout(push_constant, scalar) uniform Push {
  mat4 worldFromMesh;
  vec4 baseColor;
  int textureIndex;   // -1: none
  float alphaCutoff;
  FilterParams filterParams;
  uint vertexSum;     // the first and the last of the draw's vertices
};

layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };

// What all pixels have in common.
layout(scalar, binding = kBindFrame) uniform Frame { FrameUniforms frame; };

layout(constant_id = 4) const int kInstanced = 1;  // 0: every mesh stands in world space

#ifdef GNOMON_FRAME_OUT
#define GNOMON_FRAME_VARYING out
#else
#define GNOMON_FRAME_VARYING in
#endif
// PlaneView, of a normal turned to the light: normal, height; nearest, farthest; 1 where eye and light see one side.
layout(location = 0) GNOMON_FRAME_VARYING flat vec4 normalAndHeight;
layout(location = 1) GNOMON_FRAME_VARYING flat vec3 reachAndFacing;
layout(location = 2) GNOMON_FRAME_VARYING vec3 smoothNormalL;        // any length
layout(location = 3) GNOMON_FRAME_VARYING vec2 uv;

#endif
