#pragma once
// Light shafts in motion: the frames while the light or the camera moves, a video, and flicker.

#include "lab/fog/fog.h"

namespace gnomon {

// "light:x,y,z" or "camera:x,y,z", metres. Throws UsageError.
FogMotion parseMotion(const std::string& text, int frames);

// Runs the methods of `result.rows` on every frame; sets their flicker where there is a reference, writes
// frames below the options' folder, and says in `result.motionNote` what became of the video.
void runMotion(const SceneView& scene, ShadowPasses& passes, const FogOptions& options, FogResult& result);

// Whether the path has been taken: the camera's or the light's place at a frame.
glm::vec3 placeAt(const FogMotion& motion, const glm::vec3& startW, int frame);

}  // namespace gnomon
