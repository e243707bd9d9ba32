#pragma once
// One light as one parameterization sees it: the exact shadow, the fit, and the maps drawn of it.

#include "lab/session.h"

#include <map>

namespace gnomon {

// Maps of one fit, by what they hold; drawn when first asked for.
class MapSet {
 public:
  MapSet(const Session& session, const MapRenderer& renderer, const FittedMap& fitted, const Exact& exact,
         CullMode cull)
      : session_(session), renderer_(renderer), fitted_(fitted), exact_(exact), cull_(cull) {}

  const DrawnMap& with(MapContent content);
  // Wall clock of drawing it once more, milliseconds.
  double redraw(MapContent content);
  const FittedMap& fitted() const { return fitted_; }

 private:
  const Session& session_;
  const MapRenderer& renderer_;
  const FittedMap fitted_;
  const Exact& exact_;
  CullMode cull_;
  std::map<MapContent, DrawnMap> maps_;
};

}  // namespace gnomon
