#pragma once
// The GLSL of shaders/shared/ and the visibility pass as headers for other renderers: names with a prefix, nothing
// bound, any number of maps in a shader (docs/glsl.md).

#include <map>
#include <string>

namespace gnomon {

// File names ("visibility.glsl") and texts.
std::map<std::string, std::string> publicHeaders();

}  // namespace gnomon
