#pragma once
// Numbers as a person writes them: the whole text or none of it.

#include <optional>
#include <string>

#include <glm/glm.hpp>

namespace gnomon {

std::optional<double> parseNumber(const std::string& text);  // finite

// "1,2,3".
std::optional<glm::dvec3> tryVec3(const std::string& text);
// The same, as floats hold it. Throws UsageError that names `flag`.
glm::vec3 parseVec3(const std::string& flag, const std::string& text);

// A word that a shell takes for nothing but itself, in quotes where it must be.
std::string shellWord(const std::string& word);

}  // namespace gnomon
