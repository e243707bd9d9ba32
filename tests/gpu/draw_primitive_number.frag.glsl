// Which triangle of the draw this is, counted from 1.
layout(location = 0) out uint number;
void main() { number = uint(gl_PrimitiveID) + 1u; }
