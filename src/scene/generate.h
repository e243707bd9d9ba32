#pragma once
// The generated scenes: deterministic, with lights and cameras, each designed to provoke one artefact.

#include "scene/gltf.h"

#include <string>
#include <vector>

namespace gnomon {

struct GeneratedScene {
  const char* name;
  const char* provokes;  // one sentence: what it shows, and where it comes from
  Scene (*make)();
};

// In the order `gnomon scene` lists them.
const std::vector<GeneratedScene>& generatedScenes();

// nullptr where there is none of this name.
const GeneratedScene* findGeneratedScene(const std::string& name);

// A generated scene's name (with an optional size for `crowd`, as in "crowd:100000"), or a glTF file.
// Throws WorldError that lists the names where it is neither.
Scene openScene(const std::string& nameOrPath, const GltfOptions& options = {});

}  // namespace gnomon
