// A vertex's position in its mesh, and its uv: from the scene's tables. Where the corners are vertex attributes
// (VertexSource in src/scene/scene_buffers.h), shadow/vertex_attribute.glsl takes this file's place.
#ifndef GNOMON_VERTEX_POSITION_GLSL
#define GNOMON_VERTEX_POSITION_GLSL

#include "shared/scene.glsl"

layout(scalar, binding = kBindPositions) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

vec3 vertexPosition() { return positions[gl_VertexIndex]; }
vec2 vertexUv() { return uvs[gl_VertexIndex]; }

#endif
