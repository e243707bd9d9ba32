#include "base/parse.h"

#include "base/error.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

std::optional<double> parseNumber(const std::string& text) {
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<glm::dvec3> tryVec3(const std::string& text) {
  std::istringstream words(text);
  glm::dvec3 v(0.0);
  int count = 0;
  for (std::string word; std::getline(words, word, ','); ++count) {
    const std::optional<double> number = parseNumber(word);
    if (!number || count == 3) return std::nullopt;
    v[count] = *number;
  }
  if (count != 3) return std::nullopt;
  return v;
}

glm::vec3 parseVec3(const std::string& flag, const std::string& text) {
  const std::optional<glm::dvec3> v = tryVec3(text);
  if (!v) throw UsageError(fmt::format("{} {}: write three numbers, x,y,z", flag, text));
  return glm::vec3(*v);
}

void checkPlace(const std::string& flag, const glm::dvec3& place) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(place[axis]) <= kFarthestPlace))
      throw UsageError(fmt::format("{} {},{},{}: is too far for floats; give at most {:g} metres on each axis", flag,
                                   place.x, place.y, place.z, kFarthestPlace));
}

glm::dvec3 parsePlace(const std::string& flag, const std::string& text) {
  const std::optional<glm::dvec3> place = tryVec3(text);
  if (!place) throw UsageError(fmt::format("{} {}: write three numbers, x,y,z", flag, text));
  checkPlace(flag, *place);
  return *place;
}

std::string shellWord(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                          "_-+=.,:/%@") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace gnomon
