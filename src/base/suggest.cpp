#include "base/suggest.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Insertions, deletions, replacements and swaps of neighbours that turn a into b ("optimal string alignment").
size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::vector<std::string> splitNames(const std::string& names) {
  std::vector<std::string> list;
  for (size_t at = 0; at < names.size();) {
    const size_t end = std::min(names.find(", ", at), names.size());
    list.push_back(names.substr(at, end - at));
    at = end + 2;
  }
  return list;
}

}  // namespace

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
  constexpr size_t kLongest = 64;  // letters: no name is longer, and the distance takes their product
  const std::string wanted = lowered(word);
  if (wanted.empty() || wanted.size() > kLongest) return "";
  std::string nearest;
  size_t least = std::numeric_limits<size_t>::max();
  for (const std::string& name : names) {
    const std::string other = lowered(name);
    const size_t distance = editDistance(wanted, other);
    const bool near =
        3 * distance <= std::max(wanted.size(), other.size()) || (wanted.size() > 2 && other.starts_with(wanted));
    if (!near || distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

std::string chooseFrom(const std::string& word, const std::string& names) {
  const std::string nearest = nearestName(word, splitNames(names));
  return nearest.empty() ? "choose from " + names : fmt::format("did you mean {}? Choose from {}", nearest, names);
}

}  // namespace gnomon
