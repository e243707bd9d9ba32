// Single scattering in a homogeneous medium, through the bits of a shadow volume: each edge between light and shadow
// adds or takes away the running integral there. O(shadow edges).
#include "vsv/bits_on_ray.glsl"

vec3 integrateLit(BitsOnRay ray) {
  vec3 sum = vec3(0.0f);
  float sign_ = -1.0f;  // of the next edge: the first is one into the light
  uint before = 1u;     // the bit before the block's first
  // As far as the bit behind the last, so that the last edge is one into shadow.
  for (int block = ray.firstBin / kPhiBits; block <= (ray.lastBin + 1) / kPhiBits; ++block) {
    uvec4 words = wordsOfBlock(ray, block);
    uvec4 edges = words ^ (words << 1u | uvec4(before, words.x >> 31u, words.y >> 31u, words.z >> 31u));
    before = words.w >> 31u;
    while (edges != uvec4(0u)) {
      int bin = block * kPhiBits + takeLowestBit(edges);
      sum += runningAt(borderOnRay(bin, ray.firstBin)) * sign_;
      sign_ = -sign_;
    }
  }
  return max(sum, vec3(0.0f));  // differences round to either side of nothing
}
