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

}  // namespace gnomon
