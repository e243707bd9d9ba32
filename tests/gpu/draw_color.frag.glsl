// One colour.
layout(location = 0) out vec4 color;
layout(scalar, push_constant) uniform Push { vec4 pushedColor; };
void main() { color = pushedColor; }
