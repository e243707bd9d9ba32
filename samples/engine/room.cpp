#include "room.h"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace {

// A flat face of three or four corners, counter-clockwise seen from the front.
void face(RoomMesh& mesh, const std::vector<glm::vec3>& corners) {
  const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const auto first = static_cast<uint16_t>(mesh.vertices.size());
  for (const glm::vec3& corner : corners) mesh.vertices.push_back({corner, normal});
  for (uint16_t i = 2; i < corners.size(); ++i)
    mesh.indices.insert(mesh.indices.end(),
                        {first, static_cast<uint16_t>(first + i - 1), static_cast<uint16_t>(first + i)});
}

// Around the y axis from y0 to y1, with flat sides and lids; radii at both ends.
RoomMesh column(int sides, float y0, float y1, float r0, float r1, glm::vec3 color) {
  RoomMesh mesh{.vertices = {}, .indices = {}, .closed = true, .color = color};
  const auto ring = [&](int i, float y, float r) {
    const float a = 6.283185307f * static_cast<float>(i % sides) / static_cast<float>(sides);
    return glm::vec3(r * std::sin(a), y, r * std::cos(a));
  };
  for (int i = 0; i < sides; ++i) {
    face(mesh, {ring(i, y0, r0), ring(i + 1, y0, r0), ring(i + 1, y1, r1), ring(i, y1, r1)});
    face(mesh, {glm::vec3(0, y1, 0), ring(i, y1, r1), ring(i + 1, y1, r1)});
    face(mesh, {glm::vec3(0, y0, 0), ring(i + 1, y0, r0), ring(i, y0, r0)});
  }
  return mesh;
}

RoomMesh ball(int rings, float radius, glm::vec3 color) {
  RoomMesh mesh{.vertices = {}, .indices = {}, .closed = true, .color = color};
  const auto at = [&](int i, int k) {
    const float t = 3.14159265f * static_cast<float>(i) / static_cast<float>(rings);
    const float a = 3.14159265f * static_cast<float>(k % (2 * rings)) / static_cast<float>(rings);
    if (i == 0) return glm::vec3(0, radius, 0);
    if (i == rings) return glm::vec3(0, -radius, 0);
    return radius * glm::vec3(std::sin(t) * std::sin(a), std::cos(t), std::sin(t) * std::cos(a));
  };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < 2 * rings; ++k) {
      if (i > 0) face(mesh, {at(i, k), at(i + 1, k), at(i, k + 1)});
      if (i < rings - 1) face(mesh, {at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    }
  return mesh;
}

// Seen from both sides, so not closed.
RoomMesh walls() {
  RoomMesh mesh;
  mesh.color = {0.75f, 0.72f, 0.66f};
  const float x = 6.0f, y = 4.0f, z = 5.0f;
  face(mesh, {{-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z}});
  face(mesh, {{-x, 0, -z}, {x, 0, -z}, {x, y, -z}, {-x, y, -z}});
  face(mesh, {{-x, 0, z}, {-x, 0, -z}, {-x, y, -z}, {-x, y, z}});
  face(mesh, {{x, 0, -z}, {x, 0, z}, {x, y, z}, {x, y, -z}});
  for (int i = 0; i < 7; ++i) {  // a slatted gallery
    const float at = -4.5f + 1.5f * static_cast<float>(i);
    face(mesh, {{at, 2.9f, -5.0f}, {at, 2.9f, -2.6f}, {at + 0.9f, 2.75f, -2.6f}, {at + 0.9f, 2.75f, -5.0f}});
  }
  return mesh;
}

glm::mat4 placed(glm::vec3 at, float turn = 0.0f, float size = 1.0f) {
  glm::mat4 m(1.0f);
  m[0] = {size * std::cos(turn), 0, -size * std::sin(turn), 0};
  m[1] = {0, size, 0, 0};
  m[2] = {size * std::sin(turn), 0, size * std::cos(turn), 0};
  m[3] = glm::vec4(at, 1.0f);
  return m;
}

std::string format(const char* text, ...) {
  std::array<char, 512> buffer{};
  va_list values;
  va_start(values, text);
  std::vsnprintf(buffer.data(), buffer.size(), text, values);
  va_end(values);
  return buffer.data();
}

std::string numbers(const float* values, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += format("%s%.9g", i == 0 ? "" : ",", static_cast<double>(values[i]));
  return text;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
  }
  return text;
}

}  // namespace

Room makeRoom() {
  Room room;
  room.meshes = {walls(), column(12, 0.0f, 2.75f, 0.25f, 0.2f, {0.8f, 0.78f, 0.7f}),
                 column(4, 0.0f, 0.8f, 0.55f, 0.55f, {0.6f, 0.4f, 0.25f}), ball(12, 0.5f, {0.3f, 0.45f, 0.7f})};
  room.instances.push_back({.mesh = 0});
  for (int i = 0; i < 6; ++i)
    room.instances.push_back({.mesh = 1, .worldFromMesh = placed({-5.0f + 2.0f * static_cast<float>(i), 0, -2.6f})});
  room.instances.push_back({.mesh = 2, .worldFromMesh = placed({1.6f, 0.0f, 0.3f}, 0.5f)});
  room.instances.push_back({.mesh = 2, .worldFromMesh = placed({1.5f, 0.8f, 0.35f}, 0.9f, 0.6f)});
  room.instances.push_back({.mesh = 2, .worldFromMesh = placed({-2.7f, 0.0f, 1.2f}, 0.2f)});
  room.instances.push_back({.mesh = 3, .worldFromMesh = placed({-1.0f, 0.5f, -0.6f})});
  room.instances.push_back({.mesh = 3, .worldFromMesh = placed({3.3f, 0.3f, 1.6f}, 0.0f, 0.6f)});
  room.lower = glm::vec3(INFINITY), room.upper = glm::vec3(-INFINITY);
  for (const RoomInstance& instance : room.instances)
    for (const Vertex& vertex : room.meshes[instance.mesh].vertices) {
      const glm::vec3 p(instance.worldFromMesh * glm::vec4(vertex.position, 1.0f));
      room.lower = glm::min(room.lower, p);
      room.upper = glm::max(room.upper, p);
    }
  room.lightW = {0.3f, 2.1f, 1.1f};
  const glm::vec3 eye(2.6f, 2.4f, 6.8f), back = glm::normalize(eye - glm::vec3(0.0f, 0.9f, -1.0f));
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  room.worldFromEye =
      glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1));
  room.yFovRad = 0.95f;
  return room;
}

std::string gltfOf(const Room& room) {
  std::vector<unsigned char> bytes;
  std::string views, accessors, meshes, materials, nodes;
  const auto view = [&](const void* data, size_t size) {
    views +=
        format("%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", views.empty() ? "" : ",", bytes.size(), size);
    const auto* from = static_cast<const unsigned char*>(data);
    bytes.insert(bytes.end(), from, from + size);
    bytes.resize((bytes.size() + 3) / 4 * 4);
  };
  for (size_t i = 0; i < room.meshes.size(); ++i) {
    const RoomMesh& mesh = room.meshes[i];
    std::vector<glm::vec3> positions;
    glm::vec3 lower(INFINITY), upper(-INFINITY);
    for (const Vertex& vertex : mesh.vertices) {
      positions.push_back(vertex.position);
      lower = glm::min(lower, vertex.position), upper = glm::max(upper, vertex.position);
    }
    view(positions.data(), positions.size() * sizeof(glm::vec3));
    view(mesh.indices.data(), mesh.indices.size() * sizeof(uint16_t));
    const char* comma = i == 0 ? "" : ",";
    accessors += format("%s{\"bufferView\":%zu,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\",", comma, 2 * i,
                        positions.size());
    accessors += "\"min\":[" + numbers(&lower.x, 3) + "],\"max\":[" + numbers(&upper.x, 3) + "]},";
    accessors += format("{\"bufferView\":%zu,\"componentType\":5123,\"count\":%zu,\"type\":\"SCALAR\"}", 2 * i + 1,
                        mesh.indices.size());
    meshes += format("%s{\"primitives\":[{\"attributes\":{\"POSITION\":%zu},\"indices\":%zu,\"material\":%zu}]}", comma,
                     2 * i, 2 * i + 1, i);
    materials += format("%s{\"doubleSided\":%s,\"pbrMetallicRoughness\":{\"baseColorFactor\":[", comma,
                        mesh.closed ? "false" : "true") +
                 numbers(&mesh.color.x, 3) + ",1]}}";
  }
  for (const RoomInstance& instance : room.instances)
    nodes += format("{\"mesh\":%u,\"matrix\":[", instance.mesh) + numbers(&instance.worldFromMesh[0][0], 16) + "]},";
  nodes += "{\"name\":\"lamp\",\"translation\":[" + numbers(&room.lightW.x, 3) +
           "],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},";
  nodes += "{\"name\":\"eye\",\"camera\":0,\"matrix\":[" + numbers(&room.worldFromEye[0][0], 16) + "]}";
  std::string roots;
  for (size_t i = 0; i < room.instances.size() + 2; ++i) roots += format("%s%zu", i == 0 ? "" : ",", i);
  return "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\"],\"scene\":0,\"scenes\":[{"
         "\"nodes\":[" +
         roots + "]}],\"nodes\":[" + nodes + "],\"meshes\":[" + meshes + "],\"materials\":[" + materials +
         "],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
         "],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":40}]}}" +
         format(",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":%.9g,\"znear\":%.9g}}]",
                static_cast<double>(room.yFovRad), static_cast<double>(room.zNear)) +
         format(",\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", bytes.size()) +
         base64(bytes) + "\"}]}\n";
}
