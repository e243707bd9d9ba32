#pragma once
// Materials and their base-colour textures. Internal to the loader.

#include "scene/gltf_document.h"
#include "scene/gltf_primitive.h"
#include "scene/scene.h"

#include <vector>

namespace gnomon {

// Fills materials, textures and texels of the scene, materials in the file's order; alphaMode BLEND becomes
// Mask at cutoff 0.5, since a shadow map holds no half-transparent surface. Returns one UvSource a material.
std::vector<UvSource> loadMaterials(GltfDocument& document, Scene& scene);

}  // namespace gnomon
