#pragma once
// Pictures of a shadow volume: slices through its voxels, and its coordinates over the camera's picture.

#include "base/image.h"
#include "vsv/check/dense_volume.h"

#include "shared/light_frame.glsl"
#include "shared/scene.glsl"

#include <string>

namespace gnomon {

// What stays constant in a slice.
enum class SliceAxis { Alpha, Theta, Phi };
const char* sliceAxisName(SliceAxis axis);  // "alpha", ...

// Lit voxels light grey, shadowed ones dark, and on them as an orange line where the exact volume's shadow
// begins. One pixel a voxel; across and down: theta and phi (a shell of constant alpha), alpha and phi (a
// plane of constant theta: the light to the left), alpha and theta (a cone of constant phi).
Image8 slicePicture(const DenseVolume& volume, const ColumnBoundaries& exact, SliceAxis axis, int index);

// The slice worth looking at: the shell with the most boundary on it, the plane or cone along which the
// boundary moves most.
int busiestSlice(const ColumnBoundaries& exact, SliceAxis axis);

// Over the camera's picture: planes of constant theta (blue lines through the light), shells of constant
// alpha (yellow circles around it), and where the volume ends (orange). A view ray is one (theta, alpha), so
// they are lines.
Image8 coordinatePicture(const Image8& camera, const glsl::CameraView& view, const glsl::LightFrame& frame,
                         const glsl::EpipolarGrid& grid);

}  // namespace gnomon
