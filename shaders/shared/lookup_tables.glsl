// What a bias of surfaces (shared/surface_bias.glsl) looks up beside its tap: other texels of the map, and the scene's
// triangles with their neighbours.
//
// A few functions read them. In C++ they read the arrays of HostTables. A shader that has the tables defines
// GNOMON_LOOKUP_TABLES and the functions (shadow/fetch_lookup_tables.glsl); in one that does not they find nothing, and
// every such bias says lit. mapIdsAround() has four texels at once, the first and those after it in x, in y and in
// both, in half the time that four texelFetch take on lavapipe; beyond an edge it repeats what the edge holds.
#ifndef GNOMON_LOOKUP_TABLES_GLSL
#define GNOMON_LOOKUP_TABLES_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"
#include "shared/light_frame.glsl"
#include "shared/linked_mesh.glsl"
#include "shared/scene.glsl"
#include "shared/triangle_ids.glsl"

GNOMON_SHARED_BEGIN

// Tables that a scene has for them, beside those of shared/scene.glsl.
const int kBindMeshRows = 19;       // a texel buffer of MeshRow[], three a triangle: lavapipe fetches that faster
const int kBindIdChunks = 20;       // IdChunk[]
const int kBindTriangleFacts = 21;  // TriangleFacts[]

struct TriangleFacts {
  uint instance;  // of the mesh, where no mesh is instanced
  uint sheet;     // the connected surface it is of (src/scene/adjacency.h)
};

// Of the triangles' corners' uv, or whatever else a mask asks for.
GNOMON_CPP_ONLY(struct HostTables {
  const MeshRow* rows;
  const SceneInstance* instances;
  const IdChunk* chunks;
  const TriangleFacts* facts;
  const uint* ids;      // of the map, slice after slice
  const float* depths;  // likewise
  bool (*isHole)(const void* scene, uint triangle, uint instance, vec3 weights);
  const void* scene;
};)

struct LookupTables {
  LightFrame frame;
  float positional;  // 1: the light is a point, L's origin; 0: it shines along -z of L
  // Metres: what lies no further before the receiver's plane is the receiver's surface. Eight times the spacing of
  // floats at the scene's largest coordinate, as the exact shadow has it (src/truth/visibility.h derives it).
  float endMargin;
  int instanced;     // 0: every mesh stands in the world, once
  uint idShift;      // of shared/triangle_ids.glsl
  int masked;        // 1: some material has holes
  int mapWidth;      // texels
  int mapHeight;
  GNOMON_PUBLIC_ONLY(int source;)  // of the map, for your fetches
  GNOMON_CPP_ONLY(const HostTables* host;)
};

GNOMON_CPP_ONLY(
    inline MeshRow meshRow(LookupTables tables, uint row) { return tables.host->rows[row]; }
    inline mat4 worldFromMesh(LookupTables tables, uint instance) {
      return tables.host->instances[instance].worldFromMesh;
    }
    inline IdChunk idChunkAt(LookupTables tables, uint chunk) { return tables.host->chunks[chunk]; }
    inline TriangleFacts triangleFacts(LookupTables tables, uint triangle) { return tables.host->facts[triangle]; }
    inline bool isMeshHole(LookupTables tables, uint triangle, uint instance, vec3 weights) {
      return tables.host->isHole(tables.host->scene, triangle, instance, weights);
    }
    inline size_t texelPlace(LookupTables tables, int slice, ivec2 texel) {
      return (size_t(slice) * tables.mapHeight + texel.y) * tables.mapWidth + texel.x;
    }
    inline uint mapIdAt(LookupTables tables, int slice, ivec2 texel) {
      return tables.host->ids[texelPlace(tables, slice, texel)];
    }
    inline uvec4 mapIdsAround(LookupTables tables, int slice, ivec2 first) {
      uvec4 ids;
      for (int i = 0; i < 4; ++i)
        ids[i] = mapIdAt(tables, slice, {clamp(first.x + (i & 1), 0, tables.mapWidth - 1),
                                         clamp(first.y + (i >> 1), 0, tables.mapHeight - 1)});
      return ids;
    }
    inline float mapDepthAt(LookupTables tables, int slice, ivec2 texel) {
      return tables.host->depths[texelPlace(tables, slice, texel)];
    })

GNOMON_GLSL_ONLY(
    MeshRow meshRow(LookupTables tables, uint row);
    mat4 worldFromMesh(LookupTables tables, uint instance);
    IdChunk idChunkAt(LookupTables tables, uint chunk);
    TriangleFacts triangleFacts(LookupTables tables, uint triangle);
    bool isMeshHole(LookupTables tables, uint triangle, uint instance, vec3 weights);
    uint mapIdAt(LookupTables tables, int slice, ivec2 texel);
    uvec4 mapIdsAround(LookupTables tables, int slice, ivec2 first);
    float mapDepthAt(LookupTables tables, int slice, ivec2 texel);)

#ifndef GNOMON_LOOKUP_TABLES
GNOMON_GLSL_ONLY(
    MeshRow meshRow(LookupTables tables, uint row) { return MeshRow(vec3(0.0f), kNoLink); }
    mat4 worldFromMesh(LookupTables tables, uint instance) { return mat4(1.0f); }
    IdChunk idChunkAt(LookupTables tables, uint chunk) { return IdChunk(0u, 0u); }
    TriangleFacts triangleFacts(LookupTables tables, uint triangle) { return TriangleFacts(0u, 0u); }
    bool isMeshHole(LookupTables tables, uint triangle, uint instance, vec3 weights) { return false; }
    uint mapIdAt(LookupTables tables, int slice, ivec2 texel) { return kNoId; }
    uvec4 mapIdsAround(LookupTables tables, int slice, ivec2 first) { return uvec4(kNoId); }
    float mapDepthAt(LookupTables tables, int slice, ivec2 texel) { return 1.0f; })
#endif

// The triangle that an id names.
GNOMON_FN PlacedTriangle placedTriangle(LookupTables tables, uint id) {
  if (tables.instanced == 1) return placedInChunk(idChunkAt(tables, idChunk(id, tables.idShift)), id, tables.idShift);
  PlacedTriangle placed;
  placed.triangle = id - 1u;
  placed.instance = 0u;
  return placed;
}

// Where a corner of a mesh stands in L, by the very steps with which the receiver is brought there.
GNOMON_FN vec3 cornerInL(LookupTables tables, mat4 fromMesh, vec3 corner) {
  if (tables.instanced == 1) return lightFromWorld(tables.frame, vec3(transform(fromMesh, vec4(corner, 1.0f))));
  return lightFromWorld(tables.frame, corner);
}

GNOMON_FN mat4 placeOf(LookupTables tables, uint instance) {
  return tables.instanced == 1 ? worldFromMesh(tables, instance) : mat4(1.0f);
}

GNOMON_SHARED_END
#endif
