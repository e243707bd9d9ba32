// What the vertex shaders of DrawnAs::Bounds (src/shadow/layer_shaders.h) hand to draw_bounded_triangle.frag.glsl.
#ifdef GNOMON_BOUNDED_OUT
#define GNOMON_BOUNDED out
#else
#define GNOMON_BOUNDED in
#endif
layout(location = 0) GNOMON_BOUNDED flat vec3 sideA;
layout(location = 1) GNOMON_BOUNDED flat vec3 sideB;
layout(location = 2) GNOMON_BOUNDED flat vec3 sideC;
layout(location = 3) GNOMON_BOUNDED flat vec3 cornerA;
layout(location = 4) GNOMON_BOUNDED flat vec3 cornerB;
layout(location = 5) GNOMON_BOUNDED flat vec3 cornerC;
layout(location = 6) GNOMON_BOUNDED flat uvec2 triangleAndInstance;
