// The map of a pipeline that is made for one number of slices.
#ifndef GNOMON_SPECIALIZED_MAP_GLSL
#define GNOMON_SPECIALIZED_MAP_GLSL

#include "shared/map.glsl"

#include "shadow/map_constants.glsl"

ShadowMap specializedMap() {
  ShadowMap map = shadowMap;
  map.sliceCount = kSliceCount;
  return map;
}

#endif
