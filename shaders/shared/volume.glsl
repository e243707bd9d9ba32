// Bindings of the shaders that fill a shadow volume and look it up, beside those of shade.glsl.
#ifndef GNOMON_VOLUME_GLSL
#define GNOMON_VOLUME_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kBindSourceMap = 17;  // MapUniforms of the map that columns are looked up in
const int kBindOccluders = 18;  // float alpha a column, theta fastest; infinity where there is none
const int kBindBits = 19;       // the volume
const int kColumnGroupSide = 8;  // columns; the work group is square
const int kVoxelGroupSize = 8;  // columns of texels along theta: kThetaBlock, whose texels lie side by side

// How the bits are made of the occluders.
const int kVoxelizeSeed = 0;   // sets the first occluded voxel of each column; the rest was cleared before
const int kVoxelizeScan = 1;   // inclusive OR along alpha
const int kVoxelizeFused = 2;  // all in one: a column of texels is cleared, seeded and scanned while it is in the cache

GNOMON_SHARED_END
#endif
