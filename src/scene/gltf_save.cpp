#include "scene/gltf.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image_png.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <ostream>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

// glTF wants a far plane above 0 where it names one, and tinygltf always does; Gnomon reads none.
constexpr double kUnusedFar = 1e5;

template <typename T>
int addView(tinygltf::Model& model, const T* values, size_t count, int target) {
  std::vector<unsigned char>& data = model.buffers[0].data;
  data.resize((data.size() + 3) / 4 * 4, 0);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = count * sizeof(T);
  view.target = target;
  const unsigned char* bytes = reinterpret_cast<const unsigned char*>(values);
  data.insert(data.end(), bytes, bytes + view.byteLength);
  model.bufferViews.push_back(std::move(view));
  return static_cast<int>(model.bufferViews.size()) - 1;
}

template <typename T>
int addAccessor(tinygltf::Model& model, const std::vector<T>& values, int target, int componentType, int type) {
  tinygltf::Accessor accessor;
  accessor.bufferView = addView(model, values.data(), values.size(), target);
  accessor.count = values.size();
  accessor.componentType = componentType;
  accessor.type = type;
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size()) - 1;
}

void addBounds(tinygltf::Accessor& accessor, const std::vector<glm::vec3>& positions) {
  glm::vec3 lower = positions[0], upper = positions[0];
  for (const glm::vec3& position : positions) {
    lower = glm::min(lower, position);
    upper = glm::max(upper, position);
  }
  accessor.minValues = {lower.x, lower.y, lower.z};
  accessor.maxValues = {upper.x, upper.y, upper.z};
}

void addMeshes(tinygltf::Model& model, const Scene& scene) {
  constexpr int kVertices = TINYGLTF_TARGET_ARRAY_BUFFER, kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;
  for (const Mesh& source : scene.meshes) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = source.material;
    primitive.attributes["POSITION"] = addAccessor(model, source.positions, kVertices, kFloat, TINYGLTF_TYPE_VEC3);
    addBounds(model.accessors.back(), source.positions);
    if (!source.normals.empty())
      primitive.attributes["NORMAL"] = addAccessor(model, source.normals, kVertices, kFloat, TINYGLTF_TYPE_VEC3);
    primitive.attributes["TEXCOORD_0"] = addAccessor(model, source.uvs, kVertices, kFloat, TINYGLTF_TYPE_VEC2);
    primitive.indices = addAccessor(model, source.indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                    TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
    tinygltf::Mesh mesh;
    mesh.name = source.name;
    mesh.primitives.push_back(std::move(primitive));
    model.meshes.push_back(std::move(mesh));
  }
}

// RGBA8 as PNG, which is lossless.
std::string encodedPng(const Scene& scene, const glsl::TextureInfo& info) {
  Image8 image(info.width, info.height, 4);
  for (size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = static_cast<uint8_t>(scene.texels[info.firstTexel + i / 4] >> (8 * (i % 4)));
  return encodePng(image);
}

int wrapOf(int wrap) {
  if (wrap == glsl::kWrapClamp) return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  return wrap == glsl::kWrapMirror ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT : TINYGLTF_TEXTURE_WRAP_REPEAT;
}

// Textures that share texels share an image.
void addTextures(tinygltf::Model& model, const Scene& scene) {
  std::map<uint32_t, int> images;
  for (const glsl::TextureInfo& info : scene.textures) {
    const auto [it, isNew] = images.emplace(info.firstTexel, static_cast<int>(model.images.size()));
    if (isNew) {
      const std::string png = encodedPng(scene, info);
      tinygltf::Image image;
      image.mimeType = "image/png";
      image.bufferView = addView(model, png.data(), png.size(), 0);
      model.images.push_back(std::move(image));
    }
    const bool nearest = info.filterMode == glsl::kTexFilterNearest;
    tinygltf::Sampler sampler;
    sampler.magFilter = nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = sampler.magFilter;
    sampler.wrapS = wrapOf(info.wrapS);
    sampler.wrapT = wrapOf(info.wrapT);
    tinygltf::Texture texture;
    texture.sampler = static_cast<int>(model.samplers.size());
    texture.source = it->second;
    model.samplers.push_back(std::move(sampler));
    model.textures.push_back(std::move(texture));
  }
}

void addMaterials(tinygltf::Model& model, const Scene& scene) {
  for (const Material& source : scene.materials) {
    tinygltf::Material material;
    material.name = source.name;
    const glm::vec4& color = source.baseColor;
    material.pbrMetallicRoughness.baseColorFactor = {color.x, color.y, color.z, color.w};
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.baseColorTexture.index = source.baseColorTexture;
    material.alphaMode = source.alphaMode == AlphaMode::Mask ? "MASK" : "OPAQUE";
    material.alphaCutoff = source.alphaCutoff;
    material.doubleSided = source.doubleSided;
    model.materials.push_back(std::move(material));
  }
}

std::vector<double> numbersOf(const glm::mat4& matrix) {
  std::vector<double> numbers;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) numbers.push_back(matrix[c][r]);
  return numbers;
}

// A frame whose -z is exactly the light's direction; x and y are any that complete it.
glm::mat4 lightMatrix(const Light& light) {
  glm::mat4 matrix(1.0f);
  if (light.type != LightType::Point) {
    const glm::dvec3 z = -glm::dvec3(light.directionW);
    const glm::dvec3 other = std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, z));
    matrix[0] = glm::vec4(glm::vec3(x), 0.0f);
    matrix[1] = glm::vec4(glm::vec3(glm::cross(z, x)), 0.0f);
    matrix[2] = glm::vec4(-light.directionW, 0.0f);
  }
  if (light.type != LightType::Directional) matrix[3] = glm::vec4(light.positionW, 1.0f);
  return matrix;
}

void addNode(tinygltf::Model& model, tinygltf::Node node, const glm::mat4& matrix) {
  if (matrix != glm::mat4(1.0f)) node.matrix = numbersOf(matrix);
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(std::move(node));
}

void addLights(tinygltf::Model& model, const Scene& scene) {
  for (const Light& source : scene.lights) {
    tinygltf::Light light;
    light.name = source.name;
    light.type = source.type == LightType::Point ? "point" : source.type == LightType::Spot ? "spot" : "directional";
    light.color = {source.color.x, source.color.y, source.color.z};
    light.intensity = source.intensity;
    light.spot.innerConeAngle = source.innerConeRad;
    light.spot.outerConeAngle = source.outerConeRad;
    tinygltf::Node node;
    node.name = source.name;
    node.extensions["KHR_lights_punctual"] =
        tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(static_cast<int>(model.lights.size()))}});
    model.lights.push_back(std::move(light));
    addNode(model, std::move(node), lightMatrix(source));
  }
}

void addCameras(tinygltf::Model& model, const Scene& scene) {
  for (const Camera& source : scene.cameras) {
    tinygltf::Camera camera;
    camera.name = source.name;
    camera.type = "perspective";
    camera.perspective.yfov = source.yFovRad;
    camera.perspective.znear = source.zNear;
    camera.perspective.zfar = kUnusedFar;
    tinygltf::Node node;
    node.name = source.name;
    node.camera = static_cast<int>(model.cameras.size());
    model.cameras.push_back(std::move(camera));
    addNode(model, std::move(node), source.worldFromEye);
  }
}

tinygltf::Model modelOf(const Scene& scene) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "Gnomon";
  model.buffers.resize(1);
  model.scenes.resize(1);
  model.scenes[0].name = scene.name;
  model.defaultScene = 0;
  addMeshes(model, scene);
  addTextures(model, scene);
  addMaterials(model, scene);
  for (const Instance& instance : scene.instances) {
    tinygltf::Node node;
    node.name = instance.name;
    node.mesh = instance.mesh;
    addNode(model, std::move(node), instance.worldFromMesh);
  }
  addLights(model, scene);
  addCameras(model, scene);
  if (!scene.lights.empty()) model.extensionsUsed.push_back("KHR_lights_punctual");
  return model;
}

}  // namespace

void saveGlb(const Scene& scene, const std::filesystem::path& path) {
  const tinygltf::Model model = modelOf(scene);
  if (model.buffers[0].data.size() > std::numeric_limits<uint32_t>::max() - (64u << 20))
    throw fileError(path.string(), "a .glb holds at most 4 GiB", "save a smaller scene");
  writeFile(path, [&](std::ostream& out) {
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
      throw fileError(path.string(), "cannot be written", "tinygltf gives no reason");
  });
}

}  // namespace gnomon
