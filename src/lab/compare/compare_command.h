#pragma once
// Command lines that reproduce a comparison, or one of its rows: everything that differs from the program's defaults.

#include "lab/compare/compare.h"

#include <string>

namespace gnomon {

std::string compareCommand(const SetupOptions& setup, const CompareOptions& options);

// `gnomon render` of the first map, bias and filter, showing `show` (picturesToShow), into a file.
std::string renderCommand(const SetupOptions& setup, const CompareOptions& options, const std::string& show,
                          const std::string& file);

// Of a row that `compare` made of these: its map, light, bias, filter and knobs alone. But an unfiltered row that has
// FLIP keeps the filters that it is computed for, and a sum over lights that were tuned one by one is tuned again.
std::string rowCommand(const SetupOptions& setup, const CompareOptions& options, const Row& row);

}  // namespace gnomon
