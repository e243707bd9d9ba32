#pragma once
// One configuration as one picture: the work behind `gnomon render`.

#include "base/image.h"
#include "lab/compare/compare.h"

#include <string>
#include <vector>

namespace gnomon {

struct RenderedPicture {
  Image8 png;             // for people
  ImageF exr;             // linear data
  ExrChannels channels;   // of the latter
  std::string note;       // FittedMap::note
  double exposure = 0.0;  // per cd/m^2 (LightOnMap::exposureFactor), of a picture of light; else 0
};

// What can be shown, by name: beauty, visibility, truth, ...
std::vector<std::string> picturesToShow();

// Of one light on one map. `judged`: what judge() said of the method, where that is known already; else null.
RenderedPicture drawPicture(LightOnMap& lit, const Method& method, const ChosenFilter& filter, const std::string& show,
                            const LabelledResult* judged = nullptr);

// By the first map, bias and filter of the options. Throws UsageError, WorldError.
RenderedPicture renderPicture(const Session& session, const CompareOptions& options, const std::string& show);

// The labels of what another renderer drew of the same scene, light and camera, and in the note their counts.
// `prediction`: a picture of the session's size, each pixel's visibility in its first channel: lit from 3/4 on, in
// shadow up to 1/4; between them nothing was drawn, which is labelled uncovered. The first map is taken for the
// other's: its texels say what the other's resolution is answerable for. Throws UsageError, WorldError.
RenderedPicture renderLabelsOf(const Session& session, const CompareOptions& options,
                               const std::filesystem::path& prediction);

}  // namespace gnomon
