#pragma once
// The shadow volume as one more map: its columns are the texels of a map of one layer, its bits the depths in
// unary.

#include "vsv/shadow_volume.h"

namespace gnomon {

// `vsv`. Size, source and fit are MapOptions'; FitInput::side is that of the cube map that columns are looked
// up in.
const Parameterization& volumeParameterization();

}  // namespace gnomon
