#pragma once
// A scene: triangles, instances, lights and cameras, in metres, right-handed, y up (as in glTF).
//
// World space is W. A mesh used by one instance has its transform baked into its positions (in double), so
// that the shaders, the tracer and the labels read the very same numbers; shared meshes keep their matrices.

#include "shared/texture.glsl"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;  // metres, mesh space
  std::vector<glm::vec3> normals;    // unit, mesh space, for shading only; one a vertex, or none: triangles are flat
  std::vector<glm::vec2> uvs;        // one a vertex; zero where the file has none
  std::vector<uint32_t> indices;     // three a triangle, counter-clockwise seen from the front
  int material = 0;
  // After welding equal positions every edge is shared by exactly two oppositely wound triangles.
  bool closed = false;
  bool solidAnyway = false;  // counts as a solid if it is closed, whatever its material says
};

enum class AlphaMode { Opaque, Mask };

struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};  // linear
  int baseColorTexture = -1;  // index into Scene::textures, or -1
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;  // a texel below it is a hole
  bool doubleSided = false;
};

struct Instance {
  std::string name;
  std::string path;  // its node's ancestors and itself, "rig/lamp"; empty: no ancestors with names
  int mesh = 0;
  bool casts = true;  // a shadow; else it is only seen
  // Invertible. A negative determinant mirrors: front faces are then clockwise in mesh space.
  glm::mat4 worldFromMesh{1.0f};
};

enum class LightType { Point, Spot, Directional };

struct Light {
  std::string name;
  LightType type = LightType::Point;
  glm::vec3 positionW{0.0f};                // metres; unused for directional lights
  glm::vec3 directionW{0.0f, -1.0f, 0.0f};  // unit, the way the light travels; unused for point lights
  glm::vec3 color{1.0f};                    // linear
  float intensity = 1.0f;                   // candela (point, spot) or lux (directional)
  float innerConeRad = 0.0f;                // half angles from the axis, spot only
  float outerConeRad = 1.047197551f;        // 60 degrees: what a spot map gives a point light
  std::string path;                         // its node's ancestors and itself, "rig/lamp"; empty: not from a file
};

struct Camera {
  std::string name;
  glm::mat4 worldFromEye{1.0f};  // rigid; looks along -z, y up
  float yFovRad = 1.0f;          // vertical, full angle
  float zNear = 0.01f;           // metres
  double aspect = 0.0;           // width over height that the file asks for; 0: any
  std::string path;              // as a light's
};

struct Bounds {
  glm::vec3 lower{0.0f};
  glm::vec3 upper{0.0f};
  glm::vec3 center() const { return 0.5f * (lower + upper); }
  float diagonal() const { return glm::length(upper - lower); }
};

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;  // at least one
  std::vector<glsl::TextureInfo> textures;
  std::vector<uint32_t> texels;  // RGBA8 of all textures, sRGB colour and linear alpha
  std::vector<Instance> instances;
  std::vector<Light> lights;    // of different names
  std::vector<Camera> cameras;  // likewise
  // Where (0, 0, 0) of everything above lies in the file's coordinates. Zero, but for scenes far from their own origin:
  // floats there are too coarse to hold a shadow.
  glm::dvec3 originW{0.0};
  // What a person should know about how the file was read, a line each: first what may change a shadow.
  std::vector<std::string> notes;
  std::vector<std::string> harmlessNotes;  // what was passed over because it cannot
};

// Triangles of all instances.
uint64_t triangleCount(const Scene& scene);

// Of all instances' vertices, in world space. The diagonal is the sceneScale of Dou et al. 2014, equation 3.
Bounds computeBounds(const Scene& scene);

// A solid is closed and not doubleSided (but Mesh::solidAnyway): its back faces, seen from the light, may be culled
// from a map.
bool isSolid(const Scene& scene, const Mesh& mesh);

// Whether every edge, after welding equal positions, joins exactly two oppositely wound triangles.
// Degenerate triangles (two welded corners alike) are passed over.
bool computeClosed(const Mesh& mesh);

// Base colour (linear rgb) and alpha at uv: factor times texture, the same arithmetic as the shaders.
glm::vec4 baseColorAt(const Scene& scene, const Material& material, glm::vec2 uv);

// Looks from eyeW to targetW; up is +y, or +z where the view is vertical.
Camera lookAt(std::string name, glm::vec3 eyeW, glm::vec3 targetW, float yFovRad);

}  // namespace gnomon
