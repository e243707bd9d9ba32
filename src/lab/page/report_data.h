#pragma once
// What a report is made of: results.json as docs/results.md has it, read back and checked. Schema 3; of
// those before, which had fewer fields, what there is.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

// Kind ("labels", "depth") and path below the folder, in the order of the file.
using ReportPictures = std::vector<std::pair<std::string, std::string>>;

struct ReportElsewhere {
  std::string where;  // the other camera's name, or "512 texels"
  double biasError = 0.0, bestBiasError = 0.0, bestValue = 0.0;
};

struct ReportTuning {
  std::string knob, unit;
  double value = 0.0;
  uint64_t evaluations = 0;
  std::optional<ReportElsewhere> otherCamera, otherMapSize;
};

struct ReportPlace {
  int x = 0, y = 0, size = 0;  // upper left corner and side, pixels
  uint64_t pixels = 0;         // of the label within
};

struct ReportParam {
  std::string name, text;
  bool isKnob = false;    // of the row's bias
  std::string unit = {};  // of a knob
};

struct ReportRow {
  std::string map, bias, filter;  // map with its light, where there are several: "cube, lamp"
  std::string mapName, light;     // as --maps and --light take them; light is empty where there is one
  bool isSum = false;             // over all lights
  uint64_t mapSize = 0, layers = 0;
  std::vector<ReportParam> params;  // in the order of the file
  uint64_t scored = 0, agree = 0, acne = 0, leak = 0, edgeShadow = 0, edgeLight = 0, uncovered = 0;
  double biasError = 0.0;  // fraction
  double buildMs = 0.0, shadeMs = 0.0, frameMs = 0.0;
  std::optional<double> rmse, flip;
  bool tuned = false;
  std::optional<ReportTuning> tuning;
  std::optional<ReportPlace> worstAcne, worstLeak;
  std::string command;  // that makes it again; empty before schema 4
  ReportPictures pictures;

  uint64_t wrong() const { return scored - agree; }
};

struct ReportMap {
  std::string map, light;
  uint64_t mapSize = 0, layers = 0;
  std::optional<double> zNear, zFar;                                   // metres
  ReportPictures pictures;                                             // truth and truth_beauty among them
  std::vector<std::pair<std::string, ReportPictures>> filteredTruths;  // by filter: visibility, beauty
};

struct ReportTruth {
  std::string map, light, lightName;  // the light in words, and its name
  uint64_t scored = 0, lit = 0, facingAway = 0, outsideCone = 0, flipsHalf = 0, flipsDouble = 0;
  double margin = 0.0;  // metres
};

struct MediaData;  // media_data.h

struct ReportData {
  std::string version, device, driver, command;
  std::string sceneName, sceneSource;
  uint64_t triangles = 0;
  double sceneScale = 0.0;  // metres
  std::string cameraName;
  std::vector<double> cameraEye;
  double fovDegrees = 0.0;
  int width = 0, height = 0;  // of the pictures, pixels
  double gbufferMs = 0.0;
  std::vector<ReportTruth> truths;
  std::vector<ReportMap> maps;
  std::vector<ReportRow> rows;             // best first: by bias error, then by all wrong pixels
  std::shared_ptr<const MediaData> media;  // what gnomon fog wrote; else none
};

// Reads folder/results.json. Throws WorldError that names the file, and the field where one is wrong.
ReportData readReportData(const std::filesystem::path& folder);

}  // namespace gnomon
