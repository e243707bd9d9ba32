// Draws what encloses the projection of each triangle that a bounding compute shader wrote (append_bounded.glsl).
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind

#include "shared/bounded_triangle.glsl"
#include "shared/map.glsl"

#define GNOMON_BOUNDED_OUT
#include "shadow/bounded_varyings.glsl"

layout(scalar, binding = kBindBoundedTriangles) readonly buffer Found { BoundedTriangle found[]; };
layout(scalar, binding = kBindBoundedDraw) readonly buffer DrawArguments {
  BoundedDraw draw;
  uint drawn[];
};

void main() {
  uint which = drawn[uint(gl_VertexIndex) / 3u];
  uint corner = uint(gl_VertexIndex) % 3u;
  uint i = which >> 1u;
  gl_Position = vec4(found[i].corners[(corner + (which & 1u) * 2u) & 3u], 0.5f, 1.0f);
  // Flat: the first corner speaks for all.
  if (corner == 0u) {
    ShadowMap map = shadowMap;
    vec4 ofMap = mapDrawnNumbers(map);
    sideAAndNumber = vec4(found[i].sideA, ofMap.x);
    sideBAndNumber = vec4(found[i].sideB, ofMap.y);
    sideCAndNumber = vec4(found[i].sideC, ofMap.z);
    planeAndNumber = vec4(found[i].inverseNormal, ofMap.w);
    if (kMapKind == kMapEpipolar) moreNumbers = mapMoreDrawnNumbers(map);
    numbers = uvec4(found[i].triangle, found[i].instance, found[i].id, floatBitsToUint(map.sceneScale));
  }
}
