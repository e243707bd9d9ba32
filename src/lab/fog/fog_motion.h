#pragma once
// Light shafts in motion: the frames while the light or the camera moves, a video, and flicker.

#include "lab/fog/fog.h"

namespace gnomon {

// "light:x,y,z" or "camera:x,y,z", metres; "orbit:AXIS,DEGREES", the lights about x, y, z or a vector x,y,z. Throws
// UsageError.
FogMotion parseMotion(const std::string& text, int frames);

// Runs the methods of `result.rows` on every frame; sets their flicker where there is a reference, writes frames below
// the options' folder, and says in `result.motionNote` what became of the video. Interrupted, it ends after the last
// frame that is whole.
void runMotion(const SceneView& scene, ShadowPasses& passes, const FogOptions& options, FogResult& result);

// Of the frames 0000.png, 0001.png, ... in FOLDER/STEM a video FOLDER/STEM.mp4 for each stem, where ffmpeg is on PATH.
// What became of it, in words.
std::string writeVideos(const std::filesystem::path& folder, const std::vector<std::string>& stems);

// The camera's or a light's place at a frame, along a line.
glm::vec3 placeAt(const FogMotion& motion, const glm::vec3& startW, int frame);
// A light at a frame; an orbit's centre is the scene's.
Light lightAtFrame(const FogMotion& motion, const Light& start, const glm::vec3& centerW, int frame);
// Whether an orbit leaves a light where it is: one on the axis, which shines along it or to all sides.
bool orbitLeaves(const FogMotion& motion, const Light& light, const Bounds& boundsW);

}  // namespace gnomon
