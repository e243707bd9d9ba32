// The layer that is drawn, and the rest of LayerPush (src/shadow/layer_shaders.h).
#ifndef GNOMON_DRAWN_LAYER_GLSL
#define GNOMON_DRAWN_LAYER_GLSL

layout(push_constant, scalar) uniform Push {
  int layer;
  float tolerance;  // of depth
};

layout(constant_id = 3) const int kMultiview = 0;

int drawnLayer() { return kMultiview == 1 ? gl_ViewIndex : layer; }

#endif
