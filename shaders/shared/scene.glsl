// The scene as the shaders see it: tables filled by SceneBuffers (src/scene/scene_buffers.h).
#ifndef GNOMON_SCENE_GLSL
#define GNOMON_SCENE_GLSL

#include "shared/lang.glsl"
#include "shared/texture.glsl"

GNOMON_SHARED_BEGIN

// Binding numbers of the scene, the same in every shader that reads it.
const int kBindPositions = 0;
const int kBindTriangles = 1;
const int kBindInstances = 2;
const int kBindUvs = 3;
const int kBindMaterials = 4;
const int kBindTextures = 5;
const int kBindTexels = 6;
const int kBindNormals = 7;
const int kBindPrimitiveIds = 8;  // the G-buffer
const int kBindFirstFree = 9;  // a shader's own bindings start here

struct SceneInstance {
  mat4 worldFromMesh;
  uint firstTriangle;  // of its mesh, in the array of triangles
  uint material;
  uint firstId;  // of its first triangle (shared/triangle_ids.glsl)
};

struct SceneMaterial {
  vec4 baseColor;  // linear
  float alphaCutoff;
  int texture;     // -1: none
  int alphaMask;   // 1: holes where alpha is below the cutoff
  int doubleSided;
};

// A pixel of the G-buffer: which triangle of which instance. The first word is 0 where nothing was drawn. On the GPU
// triangles are counted through the whole array; what the CPU gets back (downloadPrimitiveIds) counts within the mesh.
struct PrimitiveId {
  uint instancePlusOne;
  uint triangle;
};

// The camera as the shaders use it. A pixel's ray starts at the eye; pixel (0,0) is the upper left one.
struct CameraView {
  mat4 clipFromWorld;
  vec3 eyeW;
  vec3 rightW;    // unit axes of the eye, in the world
  vec3 upW;
  vec3 forwardW;
  float tanHalfX;  // half the picture's width and height at distance 1
  float tanHalfY;
  int width;  // pixels
  int height;
};

// Direction (not unit) from the eye through the pixel's centre.
GNOMON_FN vec3 pixelDirection(CameraView camera, int x, int y) {
  float sx = (2.0f * (float(x) + 0.5f) / float(camera.width) - 1.0f) * camera.tanHalfX;
  float sy = (1.0f - 2.0f * (float(y) + 0.5f) / float(camera.height)) * camera.tanHalfY;
  return camera.forwardW + camera.rightW * sx + camera.upW * sy;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::SceneInstance) == 76);
static_assert(sizeof(gnomon::glsl::SceneMaterial) == 32);
static_assert(sizeof(gnomon::glsl::CameraView) == 128 && offsetof(gnomon::glsl::CameraView, height) == 124);
#endif
#endif
