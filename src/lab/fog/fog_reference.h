#pragma once
// The media reference's disk cache. A reference takes some ten thousand rays where a picture takes one, and stays the
// same as long as the scene, the lights, the camera and the medium do. It is stored next to the compiled shaders
// (GNOMON_CACHE_DIR), under a hash of everything it depends on; a damaged file is computed again.

#include "gpu/spirv_cache.h"
#include "lab/fog/fog_view.h"

namespace gnomon {

struct KeptReference {
  MediaReference reference;
  bool fromCache = false;
};
KeptReference referenceFor(const SceneView& scene, const FogView& view, const MediaReferenceOptions& options,
                           bool cache);

// What tells one reference from another.
gpu::Hash128 referenceKey(const SceneView& scene, const FogView& view, const MediaReferenceOptions& options);

// Where it is kept; empty where there is no cache.
std::filesystem::path referenceFile(const gpu::Hash128& key);

}  // namespace gnomon
