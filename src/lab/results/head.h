#pragma once
// What the results file of every verb begins with: program, scene, camera.

#include "lab/results/schema.h"

#include <glm/glm.hpp>

namespace gnomon {

struct ProgramFacts {
  std::string version, device, driver, command;

  static constexpr auto fields() {
    return std::tuple(
        field("version", &ProgramFacts::version, {.says = "of Gnomon"}),
        field("device", &ProgramFacts::device, {.says = "that Vulkan names"}),
        field("driver", &ProgramFacts::driver, {.says = "and its version"}),
        field("command", &ProgramFacts::command, {.says = "that makes the file again", .absent = Absent::Earlier}));
  }
};

struct SceneFacts {
  std::string name, source;
  size_t triangles = 0;
  float sceneScale = 0.0f;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &SceneFacts::name, {.says = "as the scene calls itself"}),
        field("source", &SceneFacts::source, {.says = "file or generator", .absent = Absent::Earlier}),
        field("triangles", &SceneFacts::triangles, {.says = "of all meshes"}),
        field("sceneScale", &SceneFacts::sceneScale, {.unit = "metres", .says = "diagonal of its bounds"}));
  }
};

struct CameraFacts {
  std::string name;
  glm::vec3 eye{0.0f}, forward{0.0f}, up{0.0f};
  float fovDegrees = 0.0f;
  int width = 0, height = 0;

  static constexpr auto fields() {
    return std::tuple(
        field("name", &CameraFacts::name, {.says = "as the scene or the command line has it"}),
        field("eye", &CameraFacts::eye, {.unit = "metres", .says = "its position"}),
        field("forward", &CameraFacts::forward, {.says = "unit vector", .absent = Absent::Earlier}),
        field("up", &CameraFacts::up, {.says = "unit vector", .absent = Absent::Earlier}),
        field("fov_degrees", &CameraFacts::fovDegrees,
              {.unit = "degrees", .says = "from the picture's foot to its top"}),
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

  static constexpr auto fields() {
    return std::tuple(
        field("schema", &ResultsHead::schema, {.says = "this version"}),
        field("gnomon", &ResultsHead::program, {.says = "the program"}),
        field("scene", &ResultsHead::scene, {.says = "what is drawn"}),
        field("camera", &ResultsHead::camera, {.says = "and the picture's size"}),
        field("gbuffer_ms", &ResultsHead::gbufferMs, {.unit = "ms", .says = "of the G-buffer; median, wall clock"}));
  }
};

}  // namespace gnomon
