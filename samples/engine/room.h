#pragma once
// The renderer's scene: a room with a gallery of columns, crates and a ball, in meshes of its own, some placed more
// than once.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

struct Vertex {
  glm::vec3 position;  // metres
  glm::vec3 normal;    // of the face
};

struct RoomMesh {
  std::vector<Vertex> vertices;
  std::vector<uint16_t> indices;
  bool closed = false;  // and drawn from outside only
  glm::vec3 color{0.7f};
};

struct RoomInstance {
  uint32_t mesh = 0;
  glm::mat4 worldFromMesh{1.0f};
};

struct Room {
  std::vector<RoomMesh> meshes;
  std::vector<RoomInstance> instances;
  glm::vec3 lower{0.0f}, upper{0.0f};  // of all that is in it
  glm::vec3 lightW{0.0f};
  glm::mat4 worldFromEye{1.0f};
  float yFovRad = 1.1f;
  float zNear = 0.05f;
};

Room makeRoom();

// The same as glTF, so that `gnomon compare room.gltf` sees what the renderer sees.
std::string gltfOf(const Room& room);
