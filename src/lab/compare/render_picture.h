#pragma once
// One configuration as one picture: the work behind `gnomon render`.

#include "base/image.h"
#include "lab/compare/compare.h"

#include <string>
#include <vector>

namespace gnomon {

struct RenderedPicture {
  Image8 png;                         // for people
  ImageF exr;                         // linear data
  std::vector<std::string> channels;  // of the latter
  std::string note;                   // FittedMap::note
};

// What can be shown, by name: beauty, visibility, truth, ...
std::vector<std::string> picturesToShow();

// By the first map, bias and filter of the options. Throws UsageError, WorldError.
RenderedPicture renderPicture(const Session& session, const CompareOptions& options, const std::string& show);

}  // namespace gnomon
