// Each texel gets its place in the download: layer after layer, row after row.
layout(local_size_x = 1) in;
layout(binding = 0, r32f) writeonly uniform image2DArray target;
void main() {
  ivec3 size = imageSize(target);
  ivec3 p = ivec3(gl_GlobalInvocationID);
  imageStore(target, p, vec4(float((p.z * size.y + p.y) * size.x + p.x), 0.0f, 0.0f, 0.0f));
}
