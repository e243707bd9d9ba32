#pragma once
// How long a sweep will take, from a few of its cases.
//
// A case that is the first of its kind in a process takes longer than those after it: its shaders are specialized and
// compiled then, and kept on disk for the sweep that comes after. So a case that takes more than its map's before it is
// measured once more, and that counts. Then the first of each map is measured on a device of its own, which loads what
// is on disk: what that takes more is counted once a map.

#include <cstddef>
#include <string>
#include <vector>

namespace gnomon {

struct CaseShape {
  std::string map;  // and its options
  int size = 0;     // texels of its side
  size_t rows = 0;  // methods by filters
};

struct TriedCase {
  CaseShape shape;
  double seconds = 0.0;  // with its shaders loaded
  double once = 0.0;     // what the first of its map takes more in a process that finds them compiled on disk
};

// Seconds of all those cases. Each takes, by row, what those tried of its map and size took on the mean; where none
// was, those of its map; else all. Of maps that were not tried, what comes once is as the mean of the others.
double extrapolatedSeconds(const std::vector<TriedCase>& tried, const std::vector<CaseShape>& missing);

// Whether a case that took so long is measured again: none of its map was before it, or those were quicker, by row.
bool mayHaveCompiled(const TriedCase& one, const std::vector<TriedCase>& before);

}  // namespace gnomon
