// What a fragment of a map has to offer to the channels of its texel.
#ifndef GNOMON_DRAWN_FRAGMENT_GLSL
#define GNOMON_DRAWN_FRAGMENT_GLSL

struct DrawnFragment {
  float depth;     // as the map has it
  uint triangle;   // in the array of all triangles
  uint instance;
  uint id;         // of both (shared/triangle_ids.glsl)
};

#endif
