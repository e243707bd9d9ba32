// The slice that is drawn, and the rest of SlicePush (src/shadow/slice_shaders.h).
#ifndef GNOMON_DRAWN_SLICE_GLSL
#define GNOMON_DRAWN_SLICE_GLSL

layout(push_constant, scalar) uniform Push {
  int slice;
  float tolerance;     // of depth
  uint rangeTriangle;  // gl_PrimitiveID counts from this one of the array of all triangles
  uint rangeId;        // which has this id
};

layout(constant_id = 3) const int kMultiview = 0;

int drawnSlice() { return kMultiview == 1 ? gl_ViewIndex : slice; }

#endif
