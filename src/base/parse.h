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

// Coordinates of lights and cameras, and how far they move, are at most this, metres. Embree's rays reach to 1.84e18,
// which a light that has moved as far as it was away must not pass; and at twice that distance the squared length of
// three coordinates, and a light of ten candela for each square metre of it, are below 3.4e38, the largest float.
inline constexpr double kFarthestPlace = 5e17;
// Throws UsageError that names `flag` where a coordinate is farther.
void checkPlace(const std::string& flag, const glm::dvec3& place);
// Three numbers in double, and checkPlace.
glm::dvec3 parsePlace(const std::string& flag, const std::string& text);

// A word that a shell takes for nothing but itself, in quotes where it must be.
std::string shellWord(const std::string& word);

}  // namespace gnomon
