#pragma once
// The comparison as an aligned table for a terminal, best first.

#include "lab/compare/compare.h"

#include <string>

namespace gnomon {

struct TableLayout {
  bool wide = false;  // all columns, whatever the width
  size_t width = 0;   // letters of a line; 0: as long as it gets
};

std::string comparisonTable(const Comparison& comparison, const TableLayout& layout = {});

// Of tuned rows: the value, how good it is elsewhere, and by what factor each method without a scene's knob
// to guess beats the best constant and slope. Empty where nothing was tuned.
std::string tuningTable(const Comparison& comparison);

// What was measured, in two or three lines: scene, light, camera, what depends on the exact shadow's margin, notes.
std::string comparisonHeader(const Session& session, const Comparison& comparison);

}  // namespace gnomon
