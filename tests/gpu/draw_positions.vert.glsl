// Clip space positions, pulled from a buffer.
layout(scalar, binding = 0) readonly buffer Positions { vec4 positions[]; };
void main() { gl_Position = positions[gl_VertexIndex]; }
