#pragma once
// The command that makes one row of a comparison again.

#include "lab/results/row.h"

namespace gnomon {

// `command` is the whole comparison's, as results.json has it. What chooses scene, light, camera, picture and
// map stays; what chooses methods becomes this row's; outputs and thresholds go.
std::string rowCommand(const std::string& command, const Row& row);

}  // namespace gnomon
