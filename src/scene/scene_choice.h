#pragma once
// What of a scene casts shadows, and which meshes count as solids, where a person says otherwise than the file.

#include "scene/scene.h"

#include <string>
#include <vector>

namespace gnomon {

enum class Solids {
  File,    // as the file says: closed, and not doubleSided
  Closed,  // every closed mesh
  Auto,    // every closed mesh, but those that hold a light or a camera of the file within their bounds: rooms
};

const std::vector<std::string>& solidsNames();  // in the order of the list
const char* solidsName(Solids solids);
Solids parseSolids(const std::string& name);  // one of solidsNames

struct SceneChoice {
  std::vector<std::string> casters;   // empty: all
  std::vector<std::string> excluded;  // of those
  Solids solids = Solids::File;
};

// A name is that of a node, a mesh, or a part of a node's path ("rig/lamp"): what stands below is meant too. What casts
// no shadow is still seen, and receives them. Throws UsageError where a name means nothing, or nothing is left to cast.
void applyChoice(Scene& scene, const SceneChoice& choice);

}  // namespace gnomon
