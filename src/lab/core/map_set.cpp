#include "lab/core/map_set.h"

namespace gnomon {

const DrawnMap& MapSet::with(ChannelSet channels) {
  const auto found = maps_.find(channels);
  if (found != maps_.end()) return found->second;
  return maps_.emplace(channels, drawMap(session_, renderers_, fitted_, exact_, channels, cull_)).first->second;
}

double MapSet::redraw(ChannelSet channels) {
  return redrawMap(session_, renderers_, with(channels), exact_, cull_);
}

}  // namespace gnomon
