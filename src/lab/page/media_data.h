#pragma once
// What gnomon fog wrote into results.json, read back and checked.

#include "lab/page/report_field.h"

namespace gnomon {

struct MediaDataRow {
  std::string integrator, map;
  std::optional<uint64_t> steps;
  std::vector<ReportParam> params;
  std::optional<double> relRmse, relRmse99, flip, flicker;
  double mapMs = 0.0, tableMs = 0.0, integrateMs = 0.0;
  ReportPictures pictures;

  double totalMs() const { return mapMs + tableMs + integrateMs; }
  std::string name() const;  // "march 128"
};

struct MediaDataFactor {
  double factor = 0.0;
  std::string bound;  // exact, at_least, at_most
};

struct MediaDataTerms {
  std::string method;  // as MediaDataRow::name
  bool withBuild = false;
  std::string measure;
  MediaDataFactor faster, better;
};

struct MediaDataReference {
  double mean = 0.0;  // cd/m^2
  double bound = 0.0, worstChange = 0.0;
  uint64_t atLimit = 0, doublings = 0, rays = 0;
  double traceMs = 0.0;
  ReportPictures pictures;
};

struct MediaDataFrames {
  uint64_t count = 0;
  std::string moves, offset, note;
};

struct MediaData {
  std::vector<std::string> lights;  // in words
  std::string sigmaS, sigmaA;       // 1/m
  double g = 0.0, reach = 0.0;
  std::optional<MediaDataReference> reference;
  std::optional<ReportPlace> worst;
  std::optional<MediaDataFrames> frames;
  std::vector<MediaDataRow> rows;
  std::vector<MediaDataTerms> terms;
};

// `root`: the whole file. Throws WorldError.
MediaData readMediaData(const ReportField& root);

}  // namespace gnomon
