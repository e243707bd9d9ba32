#pragma once
// Formats numbers and names for the pages.

#include "lab/results/light_facts.h"

namespace gnomon {

std::string grouped(uint64_t count);         // 93 863
std::string percent(double fraction);        // 0.0573 %
std::string errorText(double fraction);      // 0.0573 %, in three digits: errors run from 0.1 % to many times the mean
std::string shortNumber(double value);       // four digits
std::string rawNumber(double value);         // all of them, for a script to sort by
std::string vectorText(const glm::vec3& v);  // 1, 2.5, 3
std::string lightText(const LightFacts& light);  // name (spot) at 1, 2, 3 m towards ...
std::string mapText(const std::string& map,
                    const std::string& light);   // "cube, lamp"; the map alone where there is one light
std::string kindTitle(const std::string& kind);  // "second_depth" -> "Second depth"; a filter may follow
bool isShaded(const std::string& kind);          // a picture with many shades, which JPEG suits

// A declared number as its column shows it.
std::string cellText(const FieldNotes& notes, const std::optional<double>& value);

}  // namespace gnomon
