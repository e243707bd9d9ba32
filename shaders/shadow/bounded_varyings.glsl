// Varyings from pull_bounded_triangle.vert.glsl to draw_bounded_triangle.frag.glsl.
#ifdef GNOMON_BOUNDED_OUT
#define GNOMON_BOUNDED out
#else
#define GNOMON_BOUNDED in
#endif
layout(location = 0) GNOMON_BOUNDED flat vec3 sideA;
layout(location = 1) GNOMON_BOUNDED flat vec3 sideB;
layout(location = 2) GNOMON_BOUNDED flat vec3 sideC;
layout(location = 3) GNOMON_BOUNDED flat vec3 inverseNormal;  // of the triangle's plane (ray_triangle.glsl)
layout(location = 4) GNOMON_BOUNDED flat uvec2 triangleAndInstance;
layout(location = 5) GNOMON_BOUNDED flat uint triangleId;
