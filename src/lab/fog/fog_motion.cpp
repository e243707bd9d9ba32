#include "lab/fog/fog_motion.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/suggest.h"
#include "lab/fog/fog_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

extern char** environ;

namespace gnomon {

namespace {

namespace fs = std::filesystem;

constexpr int kFramesPerSecond = 24;
constexpr double kMostOrbitDegrees = 36000.0;  // a hundred times round
constexpr int kMostFramesShown = 6;            // on the page, of a method

// Evenly over all: the first, the last, and what lies between.
bool isShown(int frame, int frames) {
  const int shown = std::min(frames, kMostFramesShown);
  for (int i = 0; i < shown; ++i)
    if (frame == (shown == 1 ? 0 : i * (frames - 1) / (shown - 1))) return true;
  return false;
}

fs::path findProgram(const char* name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    if (::access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program)) return program;
  }
  return {};
}

// Whether it ended with 0.
bool runProgram(const fs::path& program, std::vector<std::string> words) {
  words.insert(words.begin(), program.string());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Written aside by ffmpeg, then renamed.
bool writeVideo(const fs::path& ffmpeg, const fs::path& frames, const fs::path& video) {
  const fs::path aside = video.parent_path() / (video.stem().string() + ".part.mp4");
  const bool made = runProgram(ffmpeg, {"-v", "error", "-y", "-framerate", std::to_string(kFramesPerSecond), "-i",
                                        (frames / "%04d.png").string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                        "-pix_fmt", "yuv420p", aside.string()});
  std::error_code failure;
  if (made) fs::rename(aside, video, failure);
  if (!made || failure) fs::remove(aside, failure);
  return made && !failure;
}

std::string stemOf(const MediaRow& row) {
  std::string stem = row.name();
  std::ranges::replace(stem, ' ', '_');
  return stem;
}

// The scene as the camera sees the frame, and the lights of the frame.
struct Moment {
  std::unique_ptr<SceneView> moved;
  const SceneView* scene = nullptr;
  std::vector<Light> lights;
};

Moment momentAt(const SceneView& scene, const std::vector<Light>& lights, const FogMotion& motion, int frame) {
  Moment moment{.scene = &scene, .lights = lights};
  if (motion.camera) {
    Camera camera = scene.camera();
    camera.worldFromEye[3] = glm::vec4(placeAt(motion, glm::vec3(camera.worldFromEye[3]), frame), 1.0f);
    moment.moved = std::make_unique<SceneView>(scene, camera);
    moment.scene = moment.moved.get();
  } else {
    const glm::vec3 centerW = scene.tracer().boundsW().center();
    for (Light& light : moment.lights) light = lightAtFrame(motion, light, centerW, frame);
  }
  return moment;
}

}  // namespace

std::string writeVideos(const fs::path& folder, const std::vector<std::string>& stems) {
  const fs::path ffmpeg = findProgram("ffmpeg");
  if (ffmpeg.empty()) return "frames as PNG; no video, since there is no ffmpeg on PATH";
  for (const std::string& stem : stems)
    if (!writeVideo(ffmpeg, folder / stem, folder / (stem + ".mp4")))
      return fmt::format("frames as PNG; ffmpeg failed on those of {}", stem);
  return "frames as PNG, and a video of each";
}

glm::vec3 placeAt(const FogMotion& motion, const glm::vec3& startW, int frame) {
  return startW + motion.offsetW * (static_cast<float>(frame) / static_cast<float>(motion.frames - 1));
}

Light lightAtFrame(const FogMotion& motion, const Light& start, const glm::vec3& centerW, int frame) {
  Light light = start;
  if (motion.degrees == 0.0) {
    light.positionW = placeAt(motion, start.positionW, frame);
    return light;
  }
  const double angle = glm::radians(motion.degrees) * frame / (motion.frames - 1);
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(motion.axisW)));
  light.positionW = centerW + glm::vec3(turned * glm::dvec3(start.positionW - centerW));
  light.directionW = glm::vec3(turned * glm::dvec3(start.directionW));
  return light;
}

bool orbitLeaves(const FogMotion& motion, const Light& light, const Bounds& boundsW) {
  constexpr float kTiny = 1e-5f;  // of the scene's diagonal; radians
  if (motion.degrees == 0.0) return false;
  const bool isOnAxis =
      light.type == LightType::Directional ||
      glm::length(glm::cross(motion.axisW, light.positionW - boundsW.center())) <= kTiny * boundsW.diagonal();
  const bool isAlongAxis =
      light.type == LightType::Point || glm::length(glm::cross(motion.axisW, light.directionW)) <= kTiny;
  return isOnAxis && isAlongAxis;
}

namespace {

// What follows "orbit:".
FogMotion parseOrbit(const std::string& text, const std::string& orbit, int frames) {
  const auto refuse = [&] {
    return UsageError(fmt::format(
        "--move {}: write orbit:AXIS,DEGREES, where AXIS is x, y, z or a vector x,y,z, as in orbit:y,360", text));
  };
  const size_t comma = orbit.rfind(',');
  if (comma == std::string::npos) throw refuse();
  const std::string axis = orbit.substr(0, comma);
  const std::optional<double> degrees = parseNumber(orbit.substr(comma + 1));
  const std::optional<glm::dvec3> vector = axis == "x"   ? glm::dvec3(1, 0, 0)
                                           : axis == "y" ? glm::dvec3(0, 1, 0)
                                           : axis == "z" ? glm::dvec3(0, 0, 1)
                                                         : tryVec3(axis);
  if (!degrees || !vector || *vector == glm::dvec3(0.0)) throw refuse();
  if (*degrees == 0.0 || std::abs(*degrees) > kMostOrbitDegrees)
    throw UsageError(fmt::format("--move {}: give degrees other than 0, at most {:g}", text, kMostOrbitDegrees));
  // First by its largest component, whose square may be no number.
  const glm::dvec3 size = glm::abs(*vector);
  const glm::dvec3 unit = glm::normalize(*vector / std::max({size.x, size.y, size.z}));
  return {.frames = frames, .degrees = *degrees, .axisW = glm::vec3(unit)};
}

}  // namespace

FogMotion parseMotion(const std::string& text, int frames) {
  const size_t colon = text.find(':');
  const std::string what = text.substr(0, colon);
  if (colon == std::string::npos || (what != "light" && what != "camera" && what != "orbit"))
    throw UsageError(fmt::format("--move {}: write light:x,y,z or camera:x,y,z, in metres, or orbit:AXIS,DEGREES; {}",
                                 text, chooseFrom(what, "light, camera, orbit")));
  if (frames < 2 || frames > kMostFrames)
    throw UsageError(fmt::format("--frames {}: give 2..{} frames", frames, kMostFrames));
  if (what == "orbit") return parseOrbit(text, text.substr(colon + 1), frames);
  FogMotion motion{
      .frames = frames, .camera = what == "camera", .offsetW = glm::vec3(parsePlace("--move", text.substr(colon + 1)))};
  if (motion.offsetW == glm::vec3(0.0f))
    throw UsageError(fmt::format("--move {}: the offset is zero; write it in metres", text));
  return motion;
}

void runMotion(const SceneView& scene, ShadowPasses& passes, const FogOptions& options, FogResult& result) {
  const FogMotion& motion = *options.motion;
  FogMethodOptions how{.methods = result.methods,
                       .marchMap = options.marchMap,
                       .map = options.map,
                       .mapSide = options.mapSide,
                       .cull = options.cull};
  std::vector<std::string> stems;
  for (const MediaRow& row : result.rows) stems.push_back(stemOf(row));
  if (options.truth) stems.emplace_back("reference");
  std::vector<ImageF> before(stems.size());
  std::vector<double> beyond(result.rows.size(), 0.0);
  double meanSum = 0.0;
  FogMedium medium = options.medium;
  if (motion.densityAt) medium.sigmaS = result.view.medium.sigmaS;  // of the first, whatever the next one's size
  Progress progress("frames", motion.frames);
  for (int frame = 0; frame < motion.frames && !isInterrupted(); ++frame) {
    progress.step("");
    const Moment moment = momentAt(scene, result.view.lights, motion, frame);
    if (motion.densityAt) medium.density = motion.densityAt(frame);
    FogView view = lookIntoFog(*moment.scene, passes, moment.lights, medium);
    std::vector<ImageF> images;
    for (FogMethodResult& method : runFogMethods(*moment.scene, passes, view, how))
      images.push_back(std::move(method.inScattered));
    try {
      if (options.truth)
        images.push_back(referenceFor(*moment.scene, view, options.reference, options.cache).reference.inScattered);
    } catch (const Interrupted&) {  // out of a frame that is not whole
      break;
    }
    for (size_t i = 0; i < images.size() && !options.outDir.empty(); ++i) {
      const std::string path = fmt::format("frames/{}/{:04}.png", stems[i], frame);
      writePng(options.outDir / path, exposed(composed(view, images[i]), result.exposure));
      const bool isOnPage = i == 0 || (options.truth && i + 1 == images.size());  // the first method, and the reference
      if (isOnPage && isShown(frame, motion.frames))
        result.framePictures.emplace_back(fmt::format("frame {} of {}", frame, stems[i]), path);
    }
    ++result.framesDone;
    if (options.truth) {
      meanSum += meanValue(images.back());
      for (size_t i = 0; i < beyond.size() && frame > 0; ++i)
        beyond[i] += changeBeyond(before[i], images[i], before.back(), images.back());
    }
    before = std::move(images);
  }
  const double mean = meanSum / std::max(result.framesDone, 1);
  for (size_t i = 0; i < beyond.size() && mean > 0.0 && result.framesDone > 1; ++i)
    result.rows[i].flicker = beyond[i] / (result.framesDone - 1) / mean;
  if (!options.outDir.empty() && result.framesDone > 0)
    result.motionNote = writeVideos(options.outDir / "frames", stems);
}

}  // namespace gnomon
