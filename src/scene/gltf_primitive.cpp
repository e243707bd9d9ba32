#include "scene/gltf_primitive.h"

#include "scene/gltf_accessor.h"
#include "scene/gltf_draco.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

// Of a Mesh, with room for what std::vector adds: three positions and normals and a uv, and an index.
constexpr uint64_t kVertexBytes = 2 * sizeof(glm::vec3) + sizeof(glm::vec2);
constexpr uint64_t kIndexBytes = sizeof(uint32_t);

bool isFinite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

const int* attributeOf(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto it = primitive.attributes.find(name);
  return it == primitive.attributes.end() ? nullptr : &it->second;
}

// The corners as the primitive lists them, before strips and fans are taken apart.
std::vector<uint32_t> readCorners(GltfDocument& document, const tinygltf::Primitive& primitive, size_t vertexCount,
                                  const std::string& where) {
  std::vector<uint32_t> corners;
  if (primitive.indices < 0) {
    if (vertexCount > UINT32_MAX) document.refuse(where + " has more vertices than 32 bits count", "split it");
    document.spend(vertexCount * kIndexBytes);
    corners.resize(vertexCount);
    for (size_t i = 0; i < vertexCount; ++i) corners[i] = static_cast<uint32_t>(i);
    return corners;
  }
  const AccessorView view(document, primitive.indices);
  const int type = view.componentType();
  if (view.componentCount() != 1 ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    document.refuse(fmt::format("accessor {}: indices are not unsigned scalars", primitive.indices), kRemedy);
  document.spend(view.count() * kIndexBytes);
  corners.resize(view.count());
  for (size_t i = 0; i < corners.size(); ++i) {
    corners[i] = view.index(i);
    if (corners[i] >= vertexCount)
      document.refuse(fmt::format("accessor {}: index {} is beyond the mesh's {} vertices", primitive.indices,
                                  corners[i], vertexCount),
                      kRemedy);
  }
  return corners;
}

// Every second triangle of a strip is turned, so that all have the same front (glTF 2.0, section 3.7.2.1).
std::vector<uint32_t> trianglesOf(GltfDocument& document, std::vector<uint32_t> corners, int mode,
                                  const std::string& where) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (corners.size() % 3 != 0)
      document.refuse(fmt::format("{} lists {} corners, not a multiple of 3", where, corners.size()), kRemedy);
    return corners;
  }
  std::vector<uint32_t> triangles;
  if (corners.size() < 3) return triangles;
  document.spend(3 * kIndexBytes * corners.size());
  triangles.reserve(3 * (corners.size() - 2));
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const size_t second = fan ? i + 1 : i + 1 + i % 2, third = fan ? i + 2 : i + 2 - i % 2;
    for (size_t k : {fan ? size_t{0} : i, second, third}) triangles.push_back(corners[k]);
  }
  return triangles;
}

// The vertices that triangles use, ascending; the triangles are renumbered to match.
std::vector<uint32_t> compactVertices(std::vector<uint32_t>& triangles) {
  std::vector<uint32_t> used = triangles;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  // Dense in nearly every file: all vertices are used, and keep their numbers.
  if (used.empty() || used.back() + size_t{1} == used.size()) return used;
  for (uint32_t& corner : triangles)
    corner = static_cast<uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
  return used;
}

glm::dvec3 faceNormal(const Mesh& mesh, size_t first) {
  const glm::dvec3 a(mesh.positions[mesh.indices[first]]);
  const glm::dvec3 b(mesh.positions[mesh.indices[first + 1]]);
  const glm::dvec3 c(mesh.positions[mesh.indices[first + 2]]);
  return glm::cross(b - a, c - a);
}

// Degenerate triangles have no direction; up is as good as any, and a unit vector.
glm::vec3 unitOrUp(const glm::dvec3& direction) {
  const double size = glm::length(direction);
  return size > 0.0 && std::isfinite(size) ? glm::vec3(direction / size) : glm::vec3(0.0f, 1.0f, 0.0f);
}

// Normals that are unit to within rounding stay as they are, so that a saved scene loads again equal. Those
// without a direction get the sum of their triangles' normals.
void makeUnit(Mesh& mesh) {
  constexpr double kTolerance = 1e-5;  // of the squared length; normalizing in double and rounding errs by 2e-7
  std::vector<bool> broken(mesh.normals.size(), false);
  bool anyBroken = false;
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    const glm::dvec3 normal(mesh.normals[i]);
    const double squared = glm::dot(normal, normal);
    if (std::abs(squared - 1.0) <= kTolerance) continue;
    broken[i] = !(squared > 1e-30) || !std::isfinite(squared);
    anyBroken = anyBroken || broken[i];
    mesh.normals[i] = unitOrUp(normal);
  }
  if (!anyBroken) return;
  std::vector<glm::dvec3> sums(mesh.normals.size(), glm::dvec3(0.0));
  for (size_t i = 0; i < mesh.indices.size(); ++i) sums[mesh.indices[i]] += faceNormal(mesh, i / 3 * 3);
  for (size_t i = 0; i < sums.size(); ++i)
    if (broken[i]) mesh.normals[i] = unitOrUp(sums[i]);
}

// A primitive's attributes by name, from its accessors or unpacked from Draco.
class Attributes {
 public:
  Attributes(GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& where)
      : document_(document), primitive_(primitive), draco_(unpackDraco(document, primitive, where)) {}

  const std::optional<DracoPrimitive>& draco() const { return draco_; }

  std::optional<AccessorView> find(const std::string& name) const {
    if (draco_) {
      const auto unpacked = draco_->attributes.find(name);
      if (unpacked != draco_->attributes.end()) return unpacked->second;
    }
    const int* accessor = attributeOf(primitive_, name);
    if (!accessor) return std::nullopt;
    return AccessorView(document_, *accessor);
  }

  // Of this many components and elements.
  std::optional<AccessorView> find(const std::string& name, int components, size_t count, const char* what) const {
    std::optional<AccessorView> view = find(name);
    if (!view) return view;
    const auto refuse = [&](const std::string& problem) {
      document_.refuse(fmt::format("accessor {}: {} {}", view->accessor(), what, problem), kRemedy);
    };
    if (view->componentCount() != components)
      refuse(fmt::format("has {} components, not {}", view->componentCount(), components));
    if (view->componentType() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) refuse("is of 32-bit integers");
    if (view->count() != count) refuse(fmt::format("has {} elements for {} positions", view->count(), count));
    return view;
  }

 private:
  GltfDocument& document_;
  const tinygltf::Primitive& primitive_;
  std::optional<DracoPrimitive> draco_;
};

glm::vec4 finiteAt(const GltfDocument& document, const AccessorView& view, size_t i, const char* what) {
  const glm::vec4 value = view.floats(i);
  if (!isFinite(value))
    document.refuse(fmt::format("accessor {}: {} {} is not finite", view.accessor(), what, i), kRemedy);
  return value;
}

}  // namespace

std::optional<Mesh> loadPrimitive(GltfDocument& document, const tinygltf::Primitive& primitive,
                                  const UvSource& uvSource, const std::string& where) {
  const int mode = primitive.mode;
  if (mode < 0 || mode > TINYGLTF_MODE_TRIANGLE_FAN)
    document.refuse(fmt::format("{} has the unknown mode {}", where, mode), kRemedy);
  if (mode < TINYGLTF_MODE_TRIANGLES) return std::nullopt;
  const Attributes attributes(document, primitive, where);
  std::optional<AccessorView> positions = attributes.find("POSITION");
  if (!positions) {
    document.notes.push_back(where + " has no POSITION, and is passed over");
    return std::nullopt;
  }
  const size_t vertexCount = positions->count();
  positions = attributes.find("POSITION", 3, vertexCount, "position");

  Mesh mesh;
  std::vector<uint32_t> corners =
      attributes.draco() ? attributes.draco()->corners : readCorners(document, primitive, vertexCount, where);
  mesh.indices = attributes.draco() ? std::move(corners) : trianglesOf(document, std::move(corners), mode, where);
  const std::optional<AccessorView> normals = attributes.find("NORMAL", 3, vertexCount, "normal");
  document.spend(mesh.indices.size() * kIndexBytes);  // compacting takes a copy of them
  const std::vector<uint32_t> used = compactVertices(mesh.indices);
  document.spend(used.size() * kVertexBytes);

  mesh.positions.reserve(used.size());
  for (uint32_t i : used) mesh.positions.emplace_back(finiteAt(document, *positions, i, "position"));
  mesh.uvs.assign(used.size(), glm::vec2(0.0f));
  const std::string uvName = fmt::format("TEXCOORD_{}", uvSource.set);
  if (const auto uvs = attributes.find(uvName, 2, vertexCount, "uv")) {
    const bool plain = uvSource.transform == glm::dmat3(1.0);
    for (size_t k = 0; k < used.size(); ++k) {
      // Without a texture nothing reads them, whatever they are.
      if (!uvSource.read && !isFinite(uvs->floats(used[k]))) continue;
      const glm::vec2 uv(finiteAt(document, *uvs, used[k], "uv"));
      mesh.uvs[k] = plain ? uv : glm::vec2(uvSource.transform * glm::dvec3(uv.x, uv.y, 1.0));
      if (!isFinite(glm::vec4(mesh.uvs[k], 0.0f, 0.0f)))
        document.refuse(where + " has a texture transform that leads to infinity", kRemedy);
    }
  }
  if (!normals) return mesh;
  mesh.normals.reserve(used.size());
  for (uint32_t i : used) mesh.normals.emplace_back(normals->floats(i));
  makeUnit(mesh);
  return mesh;
}

float vertexAlpha(GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& where) {
  const std::optional<AccessorView> colors = Attributes(document, primitive, where).find("COLOR_0");
  if (!colors || colors->componentCount() < 4 || colors->count() == 0) return 1.0f;
  const float alpha = colors->floats(0).w;
  for (size_t i = 1; i < colors->count(); ++i)
    if (colors->floats(i).w != alpha)
      document.refuse(
          where + " has a COLOR_0 whose alpha varies, under a material with holes; Gnomon does not read that",
          "bake it into the base colour's texture");
  return alpha;
}

}  // namespace gnomon
