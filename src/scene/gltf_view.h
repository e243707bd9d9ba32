#pragma once
// Lights and cameras of a glTF file. Internal to the loader.

#include "scene/gltf_nodes.h"
#include "scene/scene.h"

namespace gnomon {

// KHR_lights_punctual with its defaults, relative to the scene's origin; ranges are told and otherwise ignored, hidden
// lights left out. Perspective cameras made rigid, orthographic ones passed over. Names differ afterwards. Unit
// directions and rigid matrices stay as they are to the last bit, so that a saved scene loads again equal.
void loadLightsAndCameras(GltfDocument& document, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace gnomon
