// The depth as a colour.
layout(location = 0) out float depth;
void main() { depth = gl_FragCoord.z; }
