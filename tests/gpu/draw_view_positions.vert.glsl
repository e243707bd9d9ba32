// The same positions in view 0; mirrored left to right in the others, and deeper by a quarter.
layout(scalar, binding = 0) readonly buffer Positions { vec4 positions[]; };
void main() {
  gl_Position = positions[gl_VertexIndex];
  if (gl_ViewIndex > 0) gl_Position.x = -gl_Position.x;
  gl_Position.z += 0.25 * float(gl_ViewIndex);
}
