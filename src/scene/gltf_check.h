#pragma once
// Checks the JSON of a glTF file against what Gnomon reads, before tinygltf sees it. tinygltf 2.7 casts
// 64-bit numbers to int, follows buffer views without looking at their bounds, and recurses into `extras`.

#include <string>

#include <nlohmann/json.hpp>

namespace gnomon {

// Removes every property that Gnomon does not read, and throws WorldError where one that it reads has the
// wrong type, is missing, points outside its array, or where buffers and views do not fit into each other.
// `fileName` is for messages; `isBinary`: the first buffer may lie in the .glb itself.
void checkGltfJson(nlohmann::json& document, const std::string& fileName, bool isBinary);

}  // namespace gnomon
