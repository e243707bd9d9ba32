// A corner to the camera's clip space, as scene/project_to_camera.vert.glsl projects it, and the plane of its triangle,
// once for all the triangle's pixels.
#define GNOMON_FRAME_OUT
#include "shadow/frame_draw.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(scalar, binding = kBindNormals) readonly buffer Normals { vec3 normals[]; };

// By the steps of scene/surface_fetch.glsl and with which the map's casters are projected.
vec3 inLight(vec3 posM) {
  return lightFromWorld(lightFrame, kInstanced == 1 ? vec3(transform(worldFromMesh, vec4(posM, 1.0f))) : posM);
}

void main() {
  uint corner = uint(gl_VertexIndex) % 3u;
  uvec3 v = triangles[(vertexSum - uint(gl_VertexIndex)) / 3u];  // the last triangle first
  vec3 a = positions[v.x];
  vec3 b = positions[v.y];
  vec3 c = positions[v.z];
  uint own = corner == 0u ? v.x : corner == 1u ? v.y : v.z;
  vec3 posM = corner == 0u ? a : corner == 1u ? b : c;

  vec3 aL = inLight(a);
  PlaneView plane = planeView(frame.eye, frame.axisL, aL, inLight(b), inLight(c));
  float lightSide = dot(plane.normalL, shade.positional == 1.0f ? -aL : frame.towardsL);
  float turn = lightSide > 0.0f ? 1.0f : -1.0f;
  normalAndHeight = vec4(plane.normalL, plane.height) * turn;
  reachAndFacing = vec3(plane.nearest, plane.farthest, lightSide * plane.height < 0.0f ? 1.0f : 0.0f);

  vec3 normal = normals[own];
  if (kInstanced == 1) normal = transpose(inverse(mat3(worldFromMesh))) * normal;
  smoothNormalL = directionFromWorld(lightFrame, normal);
  uv = uvs[own];
  precise vec4 position = shade.camera.clipFromWorld * (worldFromMesh * vec4(posM, 1.0f));
  gl_Position = position;
}
