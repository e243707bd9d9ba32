#include "lab/core/map_set.h"

namespace gnomon {

const DrawnMap& MapSet::with(MapContent content) {
  const auto found = maps_.find(content);
  if (found != maps_.end()) return found->second;
  return maps_.emplace(content, drawMap(session_, renderers_, fitted_, exact_, content, cull_)).first->second;
}

double MapSet::redraw(MapContent content) {
  return redrawMap(session_, renderers_, with(content), exact_, cull_);
}

}  // namespace gnomon
