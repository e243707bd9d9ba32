// The density of a NanoVDB float grid, read through the package's own PNanoVDB.h.
#ifndef GNOMON_DENSITY_FETCH_GLSL
#define GNOMON_DENSITY_FETCH_GLSL

#include "shared/density.glsl"
#include "shared/media_pass.glsl"

layout(scalar, binding = kBindDensity) readonly buffer DensityWords { uint pnanovdb_buf_data[]; };
layout(scalar, binding = kBindDensityPlace) uniform PlacedDensity { DensityPlace density; };

#define PNANOVDB_GLSL
#include "nanovdb/PNanoVDB.h"

// Trilinear, and not below 0.
//
// The eight voxels about a point lie in one leaf of 8^3 voxels, or where the cell passes from one leaf to the next, in
// as many as it touches: the tree is walked down once for each of those, and not for each voxel.
float densityAtIndex(vec3 posI) {
  pnanovdb_buf_t words;
  words.unused = 0u;
  pnanovdb_grid_handle_t grid;
  grid.address.byte_offset = 0u;
  pnanovdb_root_handle_t root = pnanovdb_tree_get_root(words, pnanovdb_grid_get_tree(words, grid));

  vec3 lower = floor(posI);
  vec3 upperWeight = posI - lower;
  ivec3 cell = ivec3(lower);
  ivec3 crosses = ivec3(equal(cell & 7, ivec3(7)));  // the upper voxel lies in the next leaf
  int crossed = crosses.x | crosses.y << 1 | crosses.z << 2;
  float sum = 0.0f;
  int leaf = 0;  // a bit an axis
  do {
    ivec3 next = ivec3(leaf & 1, leaf >> 1 & 1, leaf >> 2);
    uint level;
    pnanovdb_address_t first =
        pnanovdb_root_get_value_address_and_level(PNANOVDB_GRID_TYPE_FLOAT, words, root, cell + next, level);
    // Above a leaf one value stands for all. Along a crossed axis a leaf holds one voxel of the cell, which counts as
    // both of two that have its weight together.
    uvec3 stride = uvec3(256u, 32u, 4u) * uvec3(ivec3(1) - crosses) * (level == 0u ? 1u : 0u);
    vec3 high = mix(upperWeight, vec3(0.0f), equal(crosses, ivec3(1)));
    vec3 low = mix(vec3(1.0f) - upperWeight, mix(vec3(1.0f) - upperWeight, upperWeight, equal(next, ivec3(1))),
                   equal(crosses, ivec3(1)));
    for (int corner = 0; corner < 8; ++corner) {
      uvec3 at = uvec3(corner & 1, corner >> 1 & 1, corner >> 2);
      float weight = (at.x == 1u ? high.x : low.x) * (at.y == 1u ? high.y : low.y) * (at.z == 1u ? high.z : low.z);
      pnanovdb_address_t address = pnanovdb_address_offset(first, at.x * stride.x + at.y * stride.y + at.z * stride.z);
      sum += weight * pnanovdb_read_float(words, address);
    }
    leaf = (leaf - crossed) & crossed;
  } while (leaf != 0);
  return max(sum, 0.0f);
}

#endif
