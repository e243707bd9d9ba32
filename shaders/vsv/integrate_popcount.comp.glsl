// Single scattering in a homogeneous medium, through the bits of a shadow volume: the integral over the whole view ray
// times the fraction of its bits that are lit. O(32-bit words).
#include "vsv/bits_on_ray.glsl"

vec3 integrateLit(BitsOnRay ray) {
  float litBins = 0.0f;
  for (int block = ray.firstBin / kPhiBits; block <= (ray.lastBin + 1) / kPhiBits; ++block) {
    ivec4 counts = bitCount(~wordsOfBlock(ray, block));
    litBins += float(counts.x + counts.y + counts.z + counts.w);
  }
  // A bin at an end counts as much as there is of it, and is as lit as the others.
  float share = litBins / float(ray.lastBin - ray.firstBin + 1);
  return (runningAt(binEnd) - runningAt(binBegin)) * share;
}
