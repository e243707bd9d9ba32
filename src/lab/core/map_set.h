#pragma once
// One light as one parameterization sees it: the exact shadow, the fit, and the maps drawn of it.

#include "lab/core/session.h"

#include <map>

namespace gnomon {

// Maps of one fit, by what they hold; drawn when first asked for.
class MapSet {
 public:
  MapSet(const Session& session, const Renderers& renderers, const FittedMap& fitted, const Exact& exact, CullMode cull)
      : session_(session), renderers_(renderers), fitted_(fitted), exact_(exact), cull_(cull) {}

  const DrawnMap& with(ChannelSet channels);
  // Wall clock of drawing it once more, milliseconds.
  double redraw(ChannelSet channels);
  const FittedMap& fitted() const { return fitted_; }

 private:
  const Session& session_;
  const Renderers& renderers_;
  const FittedMap fitted_;
  const Exact& exact_;
  CullMode cull_;
  std::map<ChannelSet, DrawnMap> maps_;
};

}  // namespace gnomon
