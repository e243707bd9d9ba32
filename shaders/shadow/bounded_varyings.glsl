// Varyings from pull_bounded_triangle.vert.glsl to the fragment shaders of bounded triangles.
#ifdef GNOMON_BOUNDED_OUT
#define GNOMON_BOUNDED out
#else
#define GNOMON_BOUNDED in
#endif
// In the fourth components numbers of the map (mapDrawnNumbers): lavapipe loads a uniform anew for every eight
// fragments, and divides anew, which took a third of the time in which a paraboloid is drawn. Few, because it copies
// them for every vertex.
layout(location = 0) GNOMON_BOUNDED flat vec4 sideAAndNumber;
layout(location = 1) GNOMON_BOUNDED flat vec4 sideBAndNumber;
layout(location = 2) GNOMON_BOUNDED flat vec4 sideCAndNumber;
layout(location = 3) GNOMON_BOUNDED flat vec4 planeAndNumber;  // the triangle's (inversePlaneNormal)
layout(location = 4) GNOMON_BOUNDED flat uvec4 numbers;        // triangle, instance, id; the bits of sceneScale
layout(location = 5) GNOMON_BOUNDED flat vec4 moreNumbers;     // mapMoreDrawnNumbers, of epipolar maps
