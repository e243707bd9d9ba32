// A vertex to the clip space of one slice of a planar map, by the very steps with which the receiver is projected.
#include "shared/shade.glsl"

#include "shadow/drawn_slice.glsl"
#include "shadow/vertex_position.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

layout(location = 0) out vec2 uv;
layout(location = 1) out flat uint instanceIndex;
layout(location = 2) out flat uint firstTriangle;
layout(location = 3) out flat uint firstId;

void main() {
  instanceIndex = gl_InstanceIndex;
  firstTriangle = rangeTriangle;
  firstId = rangeId;
  uv = vertexUv();
  vec3 posW = vec3(transform(instances[gl_InstanceIndex].worldFromMesh, vec4(vertexPosition(), 1.0f)));
  vec4 position = transform(mapSlices[drawnSlice()].clipFromLight, vec4(lightFromWorld(lightFrame, posW), 1.0f));
  // A face in the light's own plane has w = 0 at all corners. Nothing of it is in the slice, but with depth clamped a
  // GPU was seen to fill a whole cube face with it, at depth 0. A hair behind the light it is clipped.
  if (position.w == 0.0f) position.w = -1e-30f;
  gl_Position = position;
}
