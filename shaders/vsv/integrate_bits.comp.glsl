// Single scattering in a homogeneous medium, through the bits of a shadow volume: the integral over each lit bit,
// summed. O(bits).
#include "vsv/bits_on_ray.glsl"

vec3 integrateLit(BitsOnRay ray) {
  vec3 sum = vec3(0.0f);
  for (int block = ray.firstBin / kPhiBits; block <= (ray.lastBin + 1) / kPhiBits; ++block) {
    uvec4 lit = ~wordsOfBlock(ray, block);
    while (lit != uvec4(0u)) {
      int bin = block * kPhiBits + takeLowestBit(lit);
      sum += runningAt(min(float(bin + 1), binEnd)) - runningAt(borderOnRay(bin, ray.firstBin));
    }
  }
  return max(sum, vec3(0.0f));  // differences round to either side of nothing
}
