#pragma once
// The shadow volume as a parameterization: its columns are the texels of a one-slice map, whose depths are stored in
// unary, as bits.

#include "vsv/shadow_volume.h"

namespace gnomon {

// Where the occluders of a shadow volume come from.
enum class VolumeSource {
  Resample,  // a cube map of the scene, looked up along each column (the papers' way)
  Direct,    // the scene itself, drawn into (theta, phi), each column deciding by its own ray
};

extern const WrittenOption<VolumeSize> kVolumeSize;
extern const ChoiceOption<VolumeSource> kVolumeSource;
extern const ChoiceOption<VolumeFit> kVolumeFit;

// `vsv`. FitInput::side is that of the cube map that columns are looked up in.
const Parameterization& volumeParameterization();

}  // namespace gnomon
