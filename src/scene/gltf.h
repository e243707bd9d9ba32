#pragma once
// glTF 2.0 in and out (.gltf and .glb) through tinygltf: triangles, node transforms, instances by shared
// meshes, doubleSided, alpha masks, base colours, KHR_lights_punctual, perspective cameras.

#include "scene/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct GltfOptions {
  std::optional<int> scene;                           // of those in the file; absent: the one that it shows
  std::vector<std::filesystem::path> allowedFolders;  // beside the file's own: what its URIs may lead into
};

// Positions and cameras are taken in their rest pose: animations are not played. Skins and morph weights are refused by
// name where they would change a shape. alphaMode BLEND is read as MASK at cutoff 0.5. Orthographic cameras, lines and
// points are passed over. Only textures of base colours are read. Scene::notes tells what a file's reader should know;
// docs/gltf.md has every extension and attribute, and what becomes of it.
//
// Throws WorldError with one line for anything malformed: never crashes, hangs or asks for memory that the
// file does not back.
Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options = {});

// The same from bytes in memory, .glb or .gltf text with embedded buffers; `name` stands for the path in
// messages. This is what the fuzzer drives.
Scene loadGltfFromMemory(const unsigned char* bytes, size_t size, const std::string& name);

// Writes .glb, whole or not at all. Loading it again gives an equal scene: the same floats, lights and
// cameras, as long as a mesh of one instance is baked (see scene.h) and every texture belongs to a material.
void saveGlb(const Scene& scene, const std::filesystem::path& path);

}  // namespace gnomon
