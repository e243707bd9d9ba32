#pragma once
// The beginning of every verb's results.json: program, scene, camera.

#include "lab/results/schema.h"

#include <glm/glm.hpp>

namespace gnomon {

struct ProgramFacts {
  std::string version, device, driver, command;

  static constexpr auto fields() {
    return std::tuple(
        field("version", &ProgramFacts::version, {.says = "Gnomon's version"}),
        field("device", &ProgramFacts::device, {.says = "Vulkan device"}),
        field("driver", &ProgramFacts::driver, {.says = "Vulkan driver and version"}),
        field("command", &ProgramFacts::command, {.says = "the command line", .absent = Absent::Earlier}));
  }
};

struct SceneFacts {
  std::string name, source;
  size_t triangles = 0;
  float sceneScale = 0.0f;
  glm::vec3 origin{0.0f};

  static constexpr auto fields() {
    return std::tuple(
        field("name", &SceneFacts::name, {.says = "name of the scene"}),
        field("source", &SceneFacts::source, {.says = "file or generator", .absent = Absent::Earlier}),
        field("triangles", &SceneFacts::triangles, {.says = "number of triangles"}),
        field("sceneScale", &SceneFacts::sceneScale, {.unit = "metres", .says = "diagonal of the bounding box"}),
        field("origin", &SceneFacts::origin,
              {.unit = "metres",
               .says = "what the positions in this file are relative to, in the scene file's coordinates",
               .absent = Absent::Earlier}));
  }
};

struct CameraFacts {
  std::string name;
  glm::vec3 eye{0.0f}, forward{0.0f}, up{0.0f};
  float fovDegrees = 0.0f;
  int width = 0, height = 0;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &CameraFacts::name, {.says = "name of the camera"}),
        field("eye", &CameraFacts::eye, {.unit = "metres", .says = "position"}),
        field("forward", &CameraFacts::forward, {.says = "unit vector", .absent = Absent::Earlier}),
        field("up", &CameraFacts::up, {.says = "unit vector", .absent = Absent::Earlier}),
        field("fov_degrees", &CameraFacts::fovDegrees, {.unit = "degrees", .says = "vertical field of view"}),
        field("width", &CameraFacts::width, {.unit = "pixels", .says = "of the pictures", .most = kMaxPictureSide}),
        field("height", &CameraFacts::height, {.unit = "pixels", .says = "of the pictures", .most = kMaxPictureSide}));
  }
};

struct ResultsHead {
  int schema = kResultsVersion;
  ProgramFacts program;
  SceneFacts scene;
  CameraFacts camera;
  double gbufferMs = 0.0;
  bool isComplete = true;
  FileSums files;

  static constexpr auto fields() {
    return std::tuple(field("schema", &ResultsHead::schema, {.says = "version of this format"}),
                      field("gnomon", &ResultsHead::program, {.says = "below"}),
                      field("scene", &ResultsHead::scene, {.says = "below"}),
                      field("camera", &ResultsHead::camera, {.says = "below"}),
                      field("gbuffer_ms", &ResultsHead::gbufferMs,
                            {.unit = "ms", .says = "drawing the G-buffer; median of `--repeats`, wall clock"}),
                      field("complete", &ResultsHead::isComplete,
                            {.says = "false: the run goes on or was interrupted; here is what was done by then",
                             .absent = Absent::Earlier}),
                      field("files", &ResultsHead::files,
                            {.says = "with `-o`: each file of the run, and its CRC-32; a report refuses others",
                             .absent = Absent::Earlier}));
  }
};

}  // namespace gnomon
