// Takes the place of shadow/vertex_position.glsl where corners are vertex attributes. There are no uvs: such meshes
// have no holes.
#ifndef GNOMON_VERTEX_POSITION_GLSL
#define GNOMON_VERTEX_POSITION_GLSL

#include "shared/scene.glsl"

layout(location = 0) in vec3 attributePosition;

vec3 vertexPosition() { return attributePosition; }
vec2 vertexUv() { return vec2(0.0f); }

#endif
